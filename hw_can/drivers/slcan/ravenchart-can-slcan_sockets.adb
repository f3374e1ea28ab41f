with Interfaces.C.Strings;
with System;

package body Ravenchart.Can.Slcan_Sockets
  with SPARK_Mode => Off
--  ASM-005. Sockets are reached through the C library, by address.
is
   use type Interfaces.C.int;
   use type Interfaces.C.long;
   use type Interfaces.C.Strings.chars_ptr;

   subtype C_Int is Interfaces.C.int;

   --  The C library

   type Socket_Address is record
      Family  : Interfaces.Unsigned_16 := 2;
      Port    : Interfaces.Unsigned_16 := 0;
      Host    : Interfaces.Unsigned_32 := 0;
      Padding : Interfaces.Unsigned_64 := 0;
   end record
   with Convention => C;
   --  struct sockaddr_in; Port and Host in the order of the network.

   Address_Length : constant C_Int := 16;

   function C_Socket (Domain, Kind, Protocol : C_Int) return C_Int
   with Import, Convention => C, External_Name => "socket";

   function C_Set_Option
     (File, Level, Name : C_Int; Value : System.Address; Length : C_Int)
      return C_Int
   with Import, Convention => C, External_Name => "setsockopt";

   function C_Bind
     (File : C_Int; Name : System.Address; Length : C_Int) return C_Int
   with Import, Convention => C, External_Name => "bind";

   function C_Listen (File, Backlog : C_Int) return C_Int
   with Import, Convention => C, External_Name => "listen";

   function C_Get_Name
     (File : C_Int; Name, Length : System.Address) return C_Int
   with Import, Convention => C, External_Name => "getsockname";

   function C_Accept
     (File : C_Int; Name, Length : System.Address) return C_Int
   with Import, Convention => C, External_Name => "accept";

   function C_Receive
     (File   : C_Int;
      Data   : System.Address;
      Length : Interfaces.C.size_t;
      Flags  : C_Int) return Interfaces.C.long
   with Import, Convention => C, External_Name => "recv";

   function C_Send
     (File   : C_Int;
      Data   : System.Address;
      Length : Interfaces.C.size_t;
      Flags  : C_Int) return Interfaces.C.long
   with Import, Convention => C, External_Name => "send";

   function C_Write
     (File : C_Int; Data : System.Address; Length : Interfaces.C.size_t)
      return Interfaces.C.long
   with Import, Convention => C, External_Name => "write";

   function C_Shutdown (File, How : C_Int) return C_Int
   with Import, Convention => C, External_Name => "shutdown";

   function C_Close (File : C_Int) return C_Int
   with Import, Convention => C, External_Name => "close";

   function C_Get_Environment
     (Name : Interfaces.C.char_array) return Interfaces.C.Strings.chars_ptr
   with Import, Convention => C, External_Name => "getenv";

   function C_To_Network
     (Value : Interfaces.Unsigned_16) return Interfaces.Unsigned_16
   with Import, Convention => C, External_Name => "htons";
   --  The same both ways.

   function C_Host_To_Network
     (Value : Interfaces.Unsigned_32) return Interfaces.Unsigned_32
   with Import, Convention => C, External_Name => "htonl";

   --  The numbers of Linux

   Internet        : constant C_Int := 2;
   Stream          : constant C_Int := 1;
   Close_On_Exec   : constant C_Int := 8#2000000#;
   Socket_Level    : constant C_Int := 1;
   Reuse_Address   : constant C_Int := 2;
   Tcp_Level       : constant C_Int := 6;
   No_Delay        : constant C_Int := 1;
   No_Signal       : constant C_Int := 16#4000#;
   Both_Ways       : constant C_Int := 2;
   Standard_Output : constant C_Int := 1;
   Standard_Error  : constant C_Int := 2;
   Local_Host      : constant := 16#7F00_0001#;

   Complained : Boolean := False
   with Atomic;
   --  An open that fails is tried again; one message is enough.

   procedure Say (File : C_Int; Text : String);
   --  Write Text to File, unbuffered.

   procedure Complain (Reason : String);
   --  Say once on standard error why the server is not open.

   procedure Read_Port
     (Port : out Interfaces.Unsigned_16; Sound : out Boolean);
   --  What RAVENCHART_CAN_PORT names; 0 when it is not set.

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

   ---------------
   -- Read_Port --
   ---------------

   procedure Read_Port
     (Port : out Interfaces.Unsigned_16; Sound : out Boolean)
   is
      Setting : constant Interfaces.C.Strings.chars_ptr :=
        C_Get_Environment (Interfaces.C.To_C ("RAVENCHART_CAN_PORT"));
      Sum     : Natural := 0;
   begin
      Port  := 0;
      Sound := True;
      if Setting = Interfaces.C.Strings.Null_Ptr then
         return;
      end if;
      declare
         Text : constant String := Interfaces.C.Strings.Value (Setting);
      begin
         Sound := Text'Length > 0;
         for C of Text loop
            if C in '0' .. '9' and then Sum <= 65_535 then
               Sum := 10 * Sum + Character'Pos (C) - Character'Pos ('0');
            else
               Sound := False;
            end if;
         end loop;
      end;
      Sound := Sound and then Sum <= 65_535;
      if Sound then
         Port := Interfaces.Unsigned_16 (Sum);
      end if;
   end Read_Port;

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
      Read_Port (Port, Sound);
      if not Sound then
         Complain ("RAVENCHART_CAN_PORT must be a port, 0 to 65535");
         return;
      end if;
      File := C_Socket (Internet, Stream + Close_On_Exec, 0);
      if File < 0 then
         Complain ("no socket: the system has none left");
         return;
      end if;
      Result := C_Set_Option
        (File, Socket_Level, Reuse_Address, One'Address, 4);
      Address.Port := C_To_Network (Port);
      Address.Host := C_Host_To_Network (Local_Host);
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
           ("port" & Port'Image & " cannot be opened: is it in use?"
            & " trying again");
         Result := C_Close (File);
         return;
      end if;
      declare
         Image : constant String := C_To_Network (Address.Port)'Image;
      begin
         Say
           (Standard_Output,
            "can: slcan on 127.0.0.1:"
            & Image (Image'First + 1 .. Image'Last));
      end;
      Server := Socket (File);
   end Open_Server;

   -------------------
   -- Accept_Client --
   -------------------

   procedure Accept_Client (Server : Socket; Client : out Socket) is
      One     : aliased C_Int := 1;
      Ignored : C_Int;
      File    : constant C_Int := C_Accept
        (C_Int (Server), System.Null_Address, System.Null_Address);
   begin
      if File < 0 then
         Client := No_Socket;
      else
         Ignored := C_Set_Option
           (File, Tcp_Level, No_Delay, One'Address, 4);
         Client := Socket (File);
      end if;
   end Accept_Client;

   -------------
   -- Receive --
   -------------

   procedure Receive
     (Client : Socket; Bytes : out Chunk; Last : out Chunk_Length)
   is
      Result : Interfaces.C.long;
   begin
      Bytes  := (others => 0);
      Result := C_Receive (C_Int (Client), Bytes'Address, Chunk_Limit, 0);
      Last   := (if Result > 0 then Natural (Result) else 0);
   end Receive;

   ----------
   -- Send --
   ----------

   procedure Send
     (Client : Socket;
      Line   : Slcan.Line_Bytes;
      Last   : Slcan.Line_Length;
      Done   : out Boolean)
   is
      Copy   : constant Slcan.Line_Bytes := Line;
      Sent   : Natural := 0;
      Result : Interfaces.C.long;
   begin
      while Sent < Last loop
         Result := C_Send
           (C_Int (Client),
            Copy (Sent + 1)'Address,
            Interfaces.C.size_t (Last - Sent),
            No_Signal);
         exit when Result <= 0;
         Sent := Sent + Natural (Result);
      end loop;
      Done := Sent = Last;
   end Send;

   ---------------
   -- Break_Off --
   ---------------

   procedure Break_Off (Client : Socket) is
      Ignored : C_Int;
   begin
      Ignored := C_Shutdown (C_Int (Client), Both_Ways);
   end Break_Off;

   -----------
   -- Close --
   -----------

   procedure Close (Client : Socket) is
      Ignored : C_Int;
   begin
      Ignored := C_Close (C_Int (Client));
   end Close;

end Ravenchart.Can.Slcan_Sockets;
