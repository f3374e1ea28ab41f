--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The socket of a driver: its reader opens and closes it, its writer uses it.
--
--  Guarantees   a socket is closed only when the writer has released it: the
--               system gives the number of a closed socket to the next one
--  Tasking      one reader, one writer
--  Timing       constant; only Wait_Unused and Pause suspend
--  Analysis     one shared object, ceiling Ceiling

with Ada.Real_Time;
with System;
with Ravenchart.Can.Sockets;

generic
   Ceiling : System.Any_Priority;
   --  At least the priority of reader and writer.
package Ravenchart.Can.Connections
  with
    SPARK_Mode,
    Abstract_State =>
      ((State with Synchronous, External => (Async_Readers, Async_Writers)),
       (Wake_Up with Synchronous, External)),
    Initializes    => (State, Wake_Up)
is
   --  For the reader

   procedure Attach (To : Sockets.Socket)
   with Global => (In_Out => State);
   --  Set the socket.

   procedure Detach
   with Global => (In_Out => State);
   --  Remove the socket: no further use of it begins.

   procedure Wait_Unused
   with Global => (In_Out => Wake_Up, Input => State);
   --  Suspend the caller until the writer uses no socket.

   procedure Pause (Milliseconds : Positive)
   with Global => (Input => Ada.Real_Time.Clock_Time);
   --  Let time pass before the next attempt; called by either task.

   --  For the writer

   procedure Begin_Use (Of_Socket : out Sockets.Socket)
   with Global => (In_Out => State);
   --  The socket, which stays open until End_Use; No_Socket if there is none.

   procedure End_Use
   with Global => (In_Out => (State, Wake_Up));
   --  The writer releases the socket.

end Ravenchart.Can.Connections;
