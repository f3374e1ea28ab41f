--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Interrupts that release a sporadic processor.
--
--  Guarantees   an interrupt that comes sooner than Separation after the last
--               one that was accepted releases nothing; every other one
--               releases the processor once
--  Tasking      Arrive by any number of handlers and tasks; one caller of Wait
--  Timing       constant; only Wait suspends
--  Analysis     one shared object, of the highest ceiling
--  Assumptions  ASM-003, the clock stays within the range of Time
--
--  The wake-up is a suspension object for the reason given in
--  Ravenchart.Waiting_Queues.

with Ada.Real_Time;
with Ravenchart.Epochs;

generic
   Separation : Positive_Nanoseconds;
package Ravenchart.Interrupt_Releases
  with
    SPARK_Mode,
    Abstract_State =>
      ((State with Synchronous, External => (Async_Readers, Async_Writers)),
       (Wake_Up with Synchronous, External)),
    Initializes    => (State, Wake_Up)
is
   procedure Arrive
   with
     Global =>
       (Input  => (Epochs.Start, Ada.Real_Time.Clock_Time),
        In_Out => (State, Wake_Up));
   --  Accept an interrupt and wake the caller of Wait, or note that it came
   --  too soon. Called by the handler.

   procedure Wait (Too_Soon : out Boolean)
   with Global => (In_Out => (State, Wake_Up));
   --  Suspend the one caller until an interrupt has been accepted. Too_Soon:
   --  others came too soon since the call before.

end Ravenchart.Interrupt_Releases;
