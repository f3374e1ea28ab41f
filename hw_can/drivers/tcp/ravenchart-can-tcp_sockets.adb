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

   function Address_Of (Port : Interfaces.Unsigned_16) return Socket_Address
   is (Family  => 2,
       Port    => C_To_Network (Port),
       Host    => C_Host_To_Network (Local_Host),
       Padding => 0);
   --  The address of that port of this machine.

   procedure Hurry (File : C_Int);
   --  Send small records without delay (TCP_NODELAY).

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

   procedure Open_Server
     (Asked  : Interfaces.Unsigned_16;
      Server : out Socket;
      Given  : out Interfaces.Unsigned_16;
      Result : out Outcome)
   is
      One     : aliased C_Int := 1;
      Length  : aliased C_Int := Address_Length;
      Address : aliased Socket_Address := Address_Of (Asked);
      File    : constant C_Int :=
        C_Socket (Internet, Stream + Close_On_Exec, 0);
      Status  : C_Int;
   begin
      Server := No_Socket;
      Given  := Asked;
      Result := None_Left;
      if File < 0 then
         return;
      end if;
      Status := C_Set_Option
        (File, Socket_Level, Reuse_Address, One'Address, 4);
      if Status = 0 then
         Status := C_Bind (File, Address'Address, Address_Length);
      end if;
      if Status = 0 then
         Status := C_Listen (File, 1);
      end if;
      if Status = 0 then
         Status := C_Get_Name (File, Address'Address, Length'Address);
      end if;
      if Status = 0 then
         Server := Socket (File);
         Given  := C_To_Network (Address.Port);
         Result := Opened;
      else
         Status := C_Close (File);
         Result := Refused;
      end if;
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

   procedure Connect
     (Port   : Interfaces.Unsigned_16;
      Client : out Socket;
      Result : out Outcome)
   is
      Address : aliased Socket_Address := Address_Of (Port);
      File    : constant C_Int :=
        C_Socket (Internet, Stream + Close_On_Exec, 0);
      Status  : C_Int;
   begin
      Client := No_Socket;
      Result := None_Left;
      if File < 0 then
         return;
      end if;
      Status := C_Connect (File, Address'Address, Address_Length);
      if Status = 0 then
         Hurry (File);
         Client := Socket (File);
         Result := Opened;
      else
         Status := C_Close (File);
         Result := Refused;
      end if;
   end Connect;

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

   procedure Limit_Wait
     (Partner : Socket; To : Patience; Done : out Boolean)
   is
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
      Done :=
        C_Set_Option
          (C_Int (Partner),
           Socket_Level,
           Receive_Limit,
           Value'Address,
           Time_Value'Size / 8)
        = 0;
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
