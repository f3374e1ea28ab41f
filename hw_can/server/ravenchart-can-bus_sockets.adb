--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Real_Time;
with Ada.Streams;
with GNAT.Sockets;
with Interfaces.C;
with System;

package body Ravenchart.Can.Bus_Sockets is

   use type Ada.Real_Time.Time;
   use type Ada.Streams.Stream_Element_Offset;

   Send_Bytes : constant := 65_536;
   --  Room in the kernel for records that a client has still to read.

   subtype Offset is Ada.Streams.Stream_Element_Offset;

   Chunk : constant Offset := 64 * Bus_Records.Record_Bytes;
   --  Bytes of one read or write.

   type Link is record
      Socket : GNAT.Sockets.Socket_Type := GNAT.Sockets.No_Socket;
      Input  : Ada.Streams.Stream_Element_Array (1 .. Chunk);
      Taken  : Offset := 0;
      Read   : Offset := 0;
      Output : Ada.Streams.Stream_Element_Array (1 .. Chunk);
      Sent   : Offset := 0;
      Filled : Offset := 0;
   end record;
   --  Input holds bytes up to Read, of which those up to Taken were taken.
   --  Output holds bytes up to Filled, of which those up to Sent were sent.

   Links    : array (Node_Index) of Link;
   Server   : GNAT.Sockets.Socket_Type;
   Selector : GNAT.Sockets.Selector_Type;
   Readable : GNAT.Sockets.Socket_Set_Type;
   --  The clients with input, as the last Await saw them.
   Start    : Ada.Real_Time.Time;

   Signalled : Boolean := False
   with Atomic;

   procedure On_Signal (Number : Interfaces.C.int)
   with Convention => C;

   procedure Catch (Number : Interfaces.C.int; Handler : System.Address)
   with Import, Convention => C, External_Name => "signal";

   type C_Time is record
      Seconds     : Interfaces.C.long := 0;
      Nanoseconds : Interfaces.C.long := 0;
   end record
   with Convention => C;
   --  struct timespec.

   procedure Get_Time
     (Which : Interfaces.C.int; Time : out C_Time)
   with Import, Convention => C, External_Name => "clock_gettime";

   procedure Set_Up (Socket : GNAT.Sockets.Socket_Type);
   --  Set the socket to non-blocking and to send without delay.

   ---------------
   -- On_Signal --
   ---------------

   procedure On_Signal (Number : Interfaces.C.int) is
      pragma Unreferenced (Number);
   begin
      Signalled := True;
   end On_Signal;

   ------------
   -- Set_Up --
   ------------

   procedure Set_Up (Socket : GNAT.Sockets.Socket_Type) is
      Request : GNAT.Sockets.Request_Type :=
        (GNAT.Sockets.Non_Blocking_IO, Enabled => True);
   begin
      GNAT.Sockets.Control_Socket (Socket, Request);
      GNAT.Sockets.Set_Socket_Option
        (Socket, GNAT.Sockets.IP_Protocol_For_TCP_Level,
         (GNAT.Sockets.No_Delay, Enabled => True));
      GNAT.Sockets.Set_Socket_Option
        (Socket, GNAT.Sockets.Socket_Level,
         (GNAT.Sockets.Send_Buffer, Size => Send_Bytes));
   end Set_Up;

   ----------
   -- Open --
   ----------

   procedure Open (Port : in out Natural; Opened : out Boolean) is
      Interrupt : constant := 2;
      Terminate_Signal : constant := 15;
   begin
      GNAT.Sockets.Create_Socket (Server);
      GNAT.Sockets.Set_Socket_Option
        (Server, GNAT.Sockets.Socket_Level,
         (GNAT.Sockets.Reuse_Address, Enabled => True));
      GNAT.Sockets.Bind_Socket
        (Server,
         (Family => GNAT.Sockets.Family_Inet,
          Addr   => GNAT.Sockets.Loopback_Inet_Addr,
          Port   => GNAT.Sockets.Port_Type (Port)));
      GNAT.Sockets.Listen_Socket (Server);
      Port := Natural (GNAT.Sockets.Get_Socket_Name (Server).Port);
      GNAT.Sockets.Create_Selector (Selector);
      Catch (Interrupt, On_Signal'Address);
      Catch (Terminate_Signal, On_Signal'Address);
      Start := Ada.Real_Time.Clock;
      Opened := True;
   exception
      when GNAT.Sockets.Socket_Error =>
         Opened := False;
   end Open;

   --------------------
   -- Stop_Requested --
   --------------------

   function Stop_Requested return Boolean
   is (Signalled);

   -----------
   -- Clock --
   -----------

   function Clock return Nanoseconds
   is (Nanoseconds
         (Long_Long_Integer'(
            Long_Long_Integer
              (Ada.Real_Time.To_Duration (Ada.Real_Time.Clock - Start)
               * 1_000_000) * 1_000)));

   ----------
   -- Date --
   ----------

   function Date return Nanoseconds is
      Now : C_Time;
   begin
      Get_Time (0, Now);
      return Nanoseconds (Now.Seconds) * 1_000_000_000
        + Nanoseconds (Now.Nanoseconds);
   end Date;

   -----------
   -- Await --
   -----------

   procedure Await (Most : Nanoseconds; Welcomes : Boolean) is
      Writable : GNAT.Sockets.Socket_Set_Type;
      Status   : GNAT.Sockets.Selector_Status;
   begin
      GNAT.Sockets.Empty (Readable);
      if Welcomes then
         GNAT.Sockets.Set (Readable, Server);
      end if;
      for L of Links loop
         if GNAT.Sockets."/=" (L.Socket, GNAT.Sockets.No_Socket) then
            GNAT.Sockets.Set (Readable, L.Socket);
            if L.Sent < L.Filled then
               GNAT.Sockets.Set (Writable, L.Socket);
            end if;
         end if;
      end loop;
      GNAT.Sockets.Check_Selector
        (Selector, Readable, Writable, Status,
         Timeout => Duration (Most / 1_000) / 1_000_000);
   exception
      when GNAT.Sockets.Socket_Error =>
         GNAT.Sockets.Empty (Readable);  --  a signal came
   end Await;

   ---------------------
   -- Somebody_Knocks --
   ---------------------

   function Somebody_Knocks return Boolean
   is (GNAT.Sockets.Is_Set (Readable, Server));

   -------------
   -- Welcome --
   -------------

   procedure Welcome (C : Node_Index) is
      Address : GNAT.Sockets.Sock_Addr_Type;
      L       : Link renames Links (C);
   begin
      GNAT.Sockets.Accept_Socket (Server, L.Socket, Address);
      L.Taken  := 0;
      L.Read   := 0;
      L.Sent   := 0;
      L.Filled := 0;
      Set_Up (L.Socket);
   exception
      when GNAT.Sockets.Socket_Error =>
         null;  --  disconnected before it was accepted: it never sends hello
   end Welcome;

   -------------
   -- Receive --
   -------------

   procedure Receive (C : Node_Index; Gone : out Boolean) is
      L    : Link renames Links (C);
      Rest : constant Offset := L.Read - L.Taken;
      Last : Offset;
   begin
      Gone := False;
      if GNAT.Sockets."=" (L.Socket, GNAT.Sockets.No_Socket)
        or else not GNAT.Sockets.Is_Set (Readable, L.Socket)
      then
         return;
      end if;
      L.Input (1 .. Rest) := L.Input (L.Taken + 1 .. L.Read);
      L.Taken := 0;
      L.Read  := Rest;
      GNAT.Sockets.Receive_Socket
        (L.Socket, L.Input (Rest + 1 .. Chunk), Last);
      Gone   := Last = Rest;
      L.Read := Last;
   exception
      when Fault : GNAT.Sockets.Socket_Error =>
         Gone := GNAT.Sockets.Resolve_Exception (Fault)
           not in GNAT.Sockets.Resource_Temporarily_Unavailable
                | GNAT.Sockets.Interrupted_System_Call;
   end Receive;

   ----------
   -- Take --
   ----------

   procedure Take
     (C : Node_Index; Bytes : out Bus_Records.Image; Whole : out Boolean)
   is
      L : Link renames Links (C);
   begin
      Bytes := (others => 0);
      Whole := L.Read - L.Taken >= Bus_Records.Record_Bytes;
      if Whole then
         for I in Bytes'Range loop
            Bytes (I) :=
              Bus_Records.Byte (L.Input (L.Taken + Offset (I)));
         end loop;
         L.Taken := L.Taken + Bus_Records.Record_Bytes;
      end if;
   end Take;

   --------------
   -- Has_Room --
   --------------

   function Has_Room (C : Node_Index) return Boolean
   is (Links (C).Filled <= Chunk - Bus_Records.Record_Bytes);

   ----------
   -- Send --
   ----------

   procedure Send (C : Node_Index; Bytes : Bus_Records.Image) is
      L : Link renames Links (C);
   begin
      for I in Bytes'Range loop
         L.Output (L.Filled + Offset (I)) :=
           Ada.Streams.Stream_Element (Bytes (I));
      end loop;
      L.Filled := L.Filled + Bus_Records.Record_Bytes;
   end Send;

   -----------
   -- Flush --
   -----------

   function Flush (C : Node_Index) return Writing is
      L    : Link renames Links (C);
      Last : Offset;
   begin
      while L.Sent < L.Filled loop
         GNAT.Sockets.Send_Socket
           (L.Socket, L.Output (L.Sent + 1 .. L.Filled), Last);
         L.Sent := Last;
      end loop;
      L.Sent   := 0;
      L.Filled := 0;
      return Done;
   exception
      when Fault : GNAT.Sockets.Socket_Error =>
         case GNAT.Sockets.Resolve_Exception (Fault) is
            when GNAT.Sockets.Resource_Temporarily_Unavailable
               | GNAT.Sockets.Interrupted_System_Call =>
               return Full;
            when others                               =>
               return Lost;
         end case;
   end Flush;

   -----------
   -- Close --
   -----------

   procedure Close (C : Node_Index) is
   begin
      GNAT.Sockets.Close_Socket (Links (C).Socket);
      Links (C).Socket := GNAT.Sockets.No_Socket;
   exception
      when GNAT.Sockets.Socket_Error =>
         Links (C).Socket := GNAT.Sockets.No_Socket;
   end Close;

end Ravenchart.Can.Bus_Sockets;
