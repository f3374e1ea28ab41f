--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The way from a driver to the program: frames with the time at which they
--  came, and one task that waits for them.
--
--  Guarantees   strict order; a frame that does not fit is rejected and
--               counted
--  Tasking      any number of callers up to Ceiling; one caller of Wait
--  Timing       constant, and a reading of the clock; only Wait suspends
--  Analysis     one shared object, ceiling Ceiling

with Ada.Real_Time;
with System;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Epochs;
with Ravenchart.Queueing;

generic
   Capacity : Queueing.Capacity_Type;
   Ceiling : System.Any_Priority;
   --  At least the priority of every caller.
package Ravenchart.Can.Received_Frames
  with
    SPARK_Mode,
    Abstract_State =>
      ((State with Synchronous, External => (Async_Readers, Async_Writers)),
       (Wake_Up with Synchronous, External)),
    Initializes    => (State, Wake_Up)
is
   procedure Put (F : Any_Frames.Any_Frame)
   with
     Global =>
       (In_Out => (State, Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  F has come: stamp it, queue it, and wake the caller of Wait.

   procedure Wait
     (F : out Any_Frames.Any_Frame; Stamp : out Nanoseconds)
   with Global => (In_Out => (State, Wake_Up));
   --  Suspend the one caller until there is a frame, and hand it over with the
   --  time since Epochs.Start at which it came, 0 before that.

   function Lost return Event_Count
   with Volatile_Function, Global => State;
   --  How many frames were rejected.

end Ravenchart.Can.Received_Frames;
