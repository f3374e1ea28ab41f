--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Synchronous_Task_Control;

package body Ravenchart.Can.Connections
  with
    SPARK_Mode,
    Refined_State => (State => Link, Wake_Up => Let_Go)
is
   pragma Warnings
     (GNATprove, Off, "no Always_Terminates aspect available*",
      Reason => "ASM-008, the library does not say it of suspension objects");
   pragma Warnings
     (GNATprove, Off, "assuming * always terminates",
      Reason => "ASM-008, the library does not say it of suspension objects");

   use Ada.Synchronous_Task_Control;
   use type Ada.Real_Time.Time;
   use type Sockets.Socket;

   protected Link
     with Priority => Ceiling
   is
      procedure Set (To : Sockets.Socket);

      procedure Begin_Use (Of_Socket : out Sockets.Socket);

      procedure End_Use;

      function Is_Unused return Boolean;

   private
      Current : Sockets.Socket := Sockets.No_Socket;
      Used    : Boolean := False;
   end Link;

   Let_Go : Suspension_Object;
   --  True when the writer may have released the socket since the reader last
   --  looked.

   protected body Link is

      procedure Set (To : Sockets.Socket) is
      begin
         Current := To;
      end Set;

      procedure Begin_Use (Of_Socket : out Sockets.Socket) is
      begin
         Of_Socket := Current;
         Used      := Current /= Sockets.No_Socket;
      end Begin_Use;

      procedure End_Use is
      begin
         Used := False;
      end End_Use;

      function Is_Unused return Boolean
      is (not Used);

   end Link;

   procedure Attach (To : Sockets.Socket)
   with Refined_Global => (In_Out => Link)
   is
   begin
      Link.Set (To);
   end Attach;

   procedure Detach
   with Refined_Global => (In_Out => Link)
   is
   begin
      Link.Set (Sockets.No_Socket);
   end Detach;

   procedure Wait_Unused
   with Refined_Global => (In_Out => Let_Go, Input => Link)
   is
      Unused : Boolean;
   begin
      loop
         Unused := Link.Is_Unused;
         exit when Unused;
         Suspend_Until_True (Let_Go);
      end loop;
   end Wait_Unused;

   procedure Pause (Milliseconds : Positive) is
      Now : constant Ada.Real_Time.Time := Ada.Real_Time.Clock;
   begin
      delay until Now + Ada.Real_Time.Milliseconds (Milliseconds);
   end Pause;

   procedure Begin_Use (Of_Socket : out Sockets.Socket)
   with Refined_Global => (In_Out => Link)
   is
   begin
      Link.Begin_Use (Of_Socket);
   end Begin_Use;

   procedure End_Use
   with Refined_Global => (In_Out => (Link, Let_Go))
   is
   begin
      Link.End_Use;
      Set_True (Let_Go);
   end End_Use;

end Ravenchart.Can.Connections;
