--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces.C;
with System;
with Ravenchart.Can.Linux_Calls;

package body Ravenchart.Can.Tcp_Sockets
  with SPARK_Mode => Off
--  ASM-005. Sockets are reached through the C library, by address.
is
   use type Interfaces.C.int;
   use type Interfaces.C.long;
   use Linux_Calls;

   Bus_Port : constant := 29_536;
   --  Of a bus server that was told no other.

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

   procedure Open_Stream
     (Variable : String;
      Default  : Interfaces.Unsigned_16;
      Port     : out Interfaces.Unsigned_16;
      File     : out C_Int);
   --  A socket for the port that Variable names; negative without it.

   procedure Hurry (File : C_Int);
   --  Small records shall not wait for more.

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

   -----------------
   -- Open_Stream --
   -----------------

   procedure Open_Stream
     (Variable : String;
      Default  : Interfaces.Unsigned_16;
      Port     : out Interfaces.Unsigned_16;
      File     : out C_Int)
   is
      Sound : Boolean;
   begin
      File := -1;
      Read_Port (Variable, Default, Port, Sound);
      if Sound then
         File := C_Socket (Internet, Stream + Close_On_Exec, 0);
         if File < 0 then
            Complain ("no socket: the system has none left");
         end if;
      end if;
   end Open_Stream;

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
      File    : C_Int;
      Result  : C_Int;
   begin
      Server := No_Socket;
      Open_Stream ("RAVENCHART_CAN_PORT", 0, Port, File);
      if File < 0 then
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
      Announce ("slcan on 127.0.0.1:" & Image (C_To_Network (Address.Port)));
      Server := Socket (File);
   end Open_Server;

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
      File    : C_Int;
      Result  : C_Int;
   begin
      Client := No_Socket;
      Open_Stream ("RAVENCHART_BUS_PORT", Bus_Port, Port, File);
      if File < 0 then
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
         Announce ("joined the bus at 127.0.0.1:" & Image (Port));
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
         Result := C_Send
           (C_Int (To),
            Copy (Copy'First + Sent)'Address,
            Interfaces.C.size_t (Copy'Length - Sent),
            No_Signal);
         if Result < 0 and then C_Error = Not_A_Socket then
            Result := C_Write
              (C_Int (To),
               Copy (Copy'First + Sent)'Address,
               Interfaces.C.size_t (Copy'Length - Sent));
         end if;
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

end Ravenchart.Can.Tcp_Sockets;
