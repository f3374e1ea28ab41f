with Interfaces.C.Strings;
with System;
with Ravenchart.Can.Linux_Calls;

package body Ravenchart.Can.Tcp_Sockets
  with SPARK_Mode => Off
--  ASM-005. Sockets are reached through the C library, by address.
is
   use type Interfaces.C.int;
   use type Interfaces.C.long;
   use Linux_Calls;

   Device_File : C_Int := -1
   with Atomic;
   --  The serial line, which takes no socket calls.

   Complained : Boolean := False
   with Atomic;
   --  What fails is tried again; one message is enough.

   Bus_Port : constant := 29_536;
   --  Of a bus server that was told no other.

   procedure Say (File : C_Int; Text : String);
   --  Write Text to File, unbuffered.

   function Setting (Name : String) return String;
   --  What the environment says; nothing when it is not set.

   function Speed_Command (Rate : Nominal_Rate) return String;
   --  The command S of slcan; nothing where it has no digit for Rate.

   function Data_Speed_Command (Bus : Bus_Setting) return String;
   --  The command Y of slcan adapters with CAN FD; nothing without need.

   procedure Read_Port
     (Variable : String;
      Default  : Interfaces.Unsigned_16;
      Port     : out Interfaces.Unsigned_16;
      Sound    : out Boolean);
   --  The port that Variable names; Default when it is not set.

   function Address_Of (Port : Interfaces.Unsigned_16) return Socket_Address
   is (Family  => 2,
       Port    => C_To_Network (Port),
       Host    => C_Host_To_Network (Local_Host),
       Padding => 0);
   --  That port of this machine.

   function Image (Port : Interfaces.Unsigned_16) return String;
   --  In decimal.

   procedure Hurry (File : C_Int);
   --  Small records shall not wait for more.

   ---------
   -- Say --
   ---------

   procedure Say (File : C_Int; Text : String) is
      Line    : constant String := Text & ASCII.LF;
      Ignored : Interfaces.C.long;
   begin
      Ignored := C_Write (File, Line'Address, Line'Length);
   end Say;

   --------------
   -- Complain --
   --------------

   procedure Complain (Reason : String) is
   begin
      if not Complained then
         Complained := True;
         Say (Standard_Error, "error: can: " & Reason);
      end if;
   end Complain;

   -------------
   -- Setting --
   -------------

   function Setting (Name : String) return String is
      use type Interfaces.C.Strings.chars_ptr;
      Found : constant Interfaces.C.Strings.chars_ptr :=
        C_Get_Environment (Interfaces.C.To_C (Name));
   begin
      return
        (if Found = Interfaces.C.Strings.Null_Ptr then ""
         else Interfaces.C.Strings.Value (Found));
   end Setting;

   ---------------
   -- Read_Port --
   ---------------

   procedure Read_Port
     (Variable : String;
      Default  : Interfaces.Unsigned_16;
      Port     : out Interfaces.Unsigned_16;
      Sound    : out Boolean)
   is
      Text : constant String := Setting (Variable);
      Sum  : Natural := 0;
   begin
      Port  := Default;
      Sound := True;
      if Text = "" then
         return;
      end if;
      for C of Text loop
         if C in '0' .. '9' and then Sum <= 65_535 then
            Sum := 10 * Sum + Character'Pos (C) - Character'Pos ('0');
         else
            Sound := False;
         end if;
      end loop;
      Sound := Sound and then Sum <= 65_535;
      if Sound then
         Port := Interfaces.Unsigned_16 (Sum);
      else
         Complain (Variable & " must be a port, 0 to 65535");
      end if;
   end Read_Port;

   -----------
   -- Image --
   -----------

   function Image (Port : Interfaces.Unsigned_16) return String is
      Text : constant String := Port'Image;
   begin
      return Text (Text'First + 1 .. Text'Last);
   end Image;

   -----------
   -- Hurry --
   -----------

   procedure Hurry (File : C_Int) is
      One     : aliased C_Int := 1;
      Ignored : C_Int;
   begin
      Ignored := C_Set_Option
        (File, Tcp_Level, No_Delay, One'Address, 4);
   end Hurry;

   -----------------
   -- Open_Server --
   -----------------

   procedure Open_Server (Server : out Socket) is
      One     : aliased C_Int := 1;
      Length  : aliased C_Int := Address_Length;
      Address : aliased Socket_Address;
      Port    : Interfaces.Unsigned_16;
      Sound   : Boolean;
      File    : C_Int;
      Result  : C_Int;
   begin
      Server := No_Socket;
      Read_Port ("RAVENCHART_CAN_PORT", 0, Port, Sound);
      if not Sound then
         return;
      end if;
      File := C_Socket (Internet, Stream + Close_On_Exec, 0);
      if File < 0 then
         Complain ("no socket: the system has none left");
         return;
      end if;
      Result := C_Set_Option
        (File, Socket_Level, Reuse_Address, One'Address, 4);
      Address := Address_Of (Port);
      if Result = 0 then
         Result := C_Bind (File, Address'Address, Address_Length);
      end if;
      if Result = 0 then
         Result := C_Listen (File, 1);
      end if;
      if Result = 0 then
         Result := C_Get_Name (File, Address'Address, Length'Address);
      end if;
      if Result /= 0 then
         Complain
           ("port " & Image (Port) & " cannot be opened: is it in use?"
            & " trying again");
         Result := C_Close (File);
         return;
      end if;
      Say
        (Standard_Output,
         "can: slcan on 127.0.0.1:" & Image (C_To_Network (Address.Port)));
      Server := Socket (File);
   end Open_Server;

   --------------------
   -- Ask_For_Device --
   --------------------

   procedure Ask_For_Device (Wanted : out Boolean) is
   begin
      Wanted := Setting ("RAVENCHART_CAN_DEVICE") /= "";
   end Ask_For_Device;

   -------------------
   -- Speed_Command --
   -------------------

   function Speed_Command (Rate : Nominal_Rate) return String is
      Usual : constant array (Character range '0' .. '8') of Nominal_Rate :=
        (10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000,
         800_000, 1_000_000);
   begin
      for Digit in Usual'Range loop
         if Usual (Digit) = Rate then
            return "S" & Digit & ASCII.CR;
         end if;
      end loop;
      return "";
   end Speed_Command;

   ------------------------
   -- Data_Speed_Command --
   ------------------------

   function Data_Speed_Command (Bus : Bus_Setting) return String
   is (if Bus.Takes_Fd
         and then Bus.Data_Rate in 1_000_000 .. 8_000_000
         and then Bus.Data_Rate mod 1_000_000 = 0
       then "Y" & Character'Val
                    (Character'Pos ('0') + Bus.Data_Rate / 1_000_000)
            & ASCII.CR
       else "");

   -----------------
   -- Open_Device --
   -----------------

   procedure Open_Device (Bus : Bus_Setting; Device : out Socket) is
      Path    : constant String := Setting ("RAVENCHART_CAN_DEVICE");
      Speed   : constant String := Setting ("RAVENCHART_CAN_SPEED");
      C_Path  : constant String := Path & ASCII.NUL;
      Line    : aliased Line_Settings := (others => 0);
      Rate    : constant String :=
        (if Speed = "" then Speed_Command (Bus.Bit_Rate)
         else "S" & Speed & ASCII.CR);
      Opening : constant String :=
        "C" & ASCII.CR & Rate & Data_Speed_Command (Bus) & "O" & ASCII.CR;
      File    : C_Int;
      Result  : C_Int;
   begin
      Device := No_Socket;
      if Speed'Length > 1 or else (for some C of Speed => C not in '0' .. '8')
      then
         Complain ("RAVENCHART_CAN_SPEED must be a digit, 0 to 8");
         return;
      end if;
      File := C_Open
        (C_Path'Address, Both_Directions + No_Terminal + Close_On_Exec);
      if File < 0 then
         Complain (Path & " cannot be opened: trying again");
         return;
      end if;
      Result := C_Get_Line (File, Line'Address);
      if Result = 0 then
         C_Make_Raw (Line'Address);
         Result := C_Set_Line (File, At_Once, Line'Address);
      end if;
      if Result /= 0
        or else C_Write (File, Opening'Address, Opening'Length)
                /= Opening'Length
      then
         Complain (Path & " is no serial line: trying again");
         Result := C_Close (File);
         return;
      end if;
      Device_File := File;
      Say (Standard_Output, "can: slcan on " & Path);
      Device := Socket (File);
   end Open_Device;

   -------------------
   -- Accept_Client --
   -------------------

   procedure Accept_Client (Server : Socket; Client : out Socket) is
      File : constant C_Int := C_Accept
        (C_Int (Server), System.Null_Address, System.Null_Address);
   begin
      if File < 0 then
         Client := No_Socket;
      else
         Hurry (File);
         Client := Socket (File);
      end if;
   end Accept_Client;

   -------------
   -- Connect --
   -------------

   procedure Connect (Client : out Socket) is
      Address : aliased Socket_Address;
      Port    : Interfaces.Unsigned_16;
      Sound   : Boolean;
      File    : C_Int;
      Result  : C_Int;
   begin
      Client := No_Socket;
      Read_Port ("RAVENCHART_BUS_PORT", Bus_Port, Port, Sound);
      if not Sound then
         return;
      end if;
      File := C_Socket (Internet, Stream + Close_On_Exec, 0);
      if File < 0 then
         Complain ("no socket: the system has none left");
         return;
      end if;
      Address := Address_Of (Port);
      Result  := C_Connect (File, Address'Address, Address_Length);
      if Result /= 0 then
         Complain
           ("no bus server at 127.0.0.1:" & Image (Port)
            & ": trying again");
         Result := C_Close (File);
         return;
      end if;
      Hurry (File);
      Client := Socket (File);
   end Connect;

   ---------------------
   -- Announce_Joined --
   ---------------------

   procedure Announce_Joined is
      Port  : Interfaces.Unsigned_16;
      Sound : Boolean;
   begin
      Read_Port ("RAVENCHART_BUS_PORT", Bus_Port, Port, Sound);
      if Sound then
         Say
           (Standard_Output,
            "can: joined the bus at 127.0.0.1:" & Image (Port));
      end if;
   end Announce_Joined;

   ---------------
   -- Read_Name --
   ---------------

   procedure Read_Name (Text : out Name_Text; Last : out Name_Length) is
      Found : constant String := Setting ("RAVENCHART_BUS_NAME");
   begin
      Last := Natural'Min (Found'Length, Name_Length'Last);
      Text := (others => ' ');
      Text (1 .. Last) := Found (Found'First .. Found'First + Last - 1);
   end Read_Name;

   -------------
   -- Receive --
   -------------

   procedure Receive
     (From : Socket; Bytes : out Chunk; Last : out Chunk_Length)
   is
      Result : Interfaces.C.long;
   begin
      Bytes  := (others => 0);
      Result := C_Read (C_Int (From), Bytes'Address, Chunk_Limit);
      Last   := (if Result > 0 then Natural (Result) else 0);
   end Receive;

   -----------------
   -- Receive_All --
   -----------------

   procedure Receive_All
     (From : Socket; Bytes : out Octets; Done : out Boolean)
   is
      Got    : Natural := 0;
      Result : Interfaces.C.long;
   begin
      Bytes := (others => 0);
      while Got < Bytes'Length loop
         Result := C_Receive
           (C_Int (From),
            Bytes (Bytes'First + Got)'Address,
            Interfaces.C.size_t (Bytes'Length - Got),
            Wait_For_All);
         exit when Result <= 0;
         Got := Got + Natural (Result);
      end loop;
      Done := Got = Bytes'Length;
   end Receive_All;

   ----------------
   -- Limit_Wait --
   ----------------

   procedure Limit_Wait (Partner : Socket; To : Patience) is
      type Time_Value is record
         Seconds      : Interfaces.C.long;
         Microseconds : Interfaces.C.long;
      end record
      with Convention => C;

      Milliseconds : constant Interfaces.C.long := Interfaces.C.long (To);
      Value        : aliased Time_Value :=
        (Seconds      => Milliseconds / 1_000,
         Microseconds => Milliseconds mod 1_000 * 1_000);
   begin
      if C_Set_Option
           (C_Int (Partner),
            Socket_Level,
            Receive_Limit,
            Value'Address,
            Time_Value'Size / 8)
        /= 0
      then
         Complain ("this system has no limit for the wait on a socket");
      end if;
   end Limit_Wait;

   ----------
   -- Send --
   ----------

   procedure Send (To : Socket; Bytes : Octets; Done : out Boolean) is
      Copy   : constant Octets := Bytes;
      Sent   : Natural := 0;
      Result : Interfaces.C.long;
   begin
      while Sent < Copy'Length loop
         Result :=
           (if C_Int (To) = Device_File
            then C_Write
              (C_Int (To),
               Copy (Copy'First + Sent)'Address,
               Interfaces.C.size_t (Copy'Length - Sent))
            else C_Send
              (C_Int (To),
               Copy (Copy'First + Sent)'Address,
               Interfaces.C.size_t (Copy'Length - Sent),
               No_Signal));
         exit when Result <= 0;
         Sent := Sent + Natural (Result);
      end loop;
      Done := Sent = Copy'Length;
   end Send;

   ---------------
   -- Break_Off --
   ---------------

   procedure Break_Off (Partner : Socket) is
      Ignored : C_Int;
   begin
      Ignored := C_Shutdown (C_Int (Partner), Both_Ways);
   end Break_Off;

   -----------
   -- Close --
   -----------

   procedure Close (Partner : Socket) is
      Ignored : C_Int;
   begin
      if C_Int (Partner) = Device_File then
         Device_File := -1;
      end if;
      Ignored := C_Close (C_Int (Partner));
   end Close;

end Ravenchart.Can.Tcp_Sockets;
