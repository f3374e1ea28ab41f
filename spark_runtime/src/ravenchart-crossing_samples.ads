--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The mailbox of a sampled port whose sender runs on another core: it holds
--  the sample sent last, and each sample is taken once.
--
--  Guarantees   those of Crossing_Boards; a sample that a newer one replaces
--               is never taken, and that is no loss
--  Tasking      one task puts, one task takes; neither ever waits
--  Timing       the time to copy one Element_Type
--  Analysis     no shared object: no ceiling, no blocking
--  Assumptions  ASM-023, atomic objects order the accesses of two cores

with Ravenchart.Queueing;

generic
   type Element_Type is private;
   Null_Element : Element_Type;
   --  The element that Take returns when Empty.
package Ravenchart.Crossing_Samples
  with
    SPARK_Mode,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   procedure Put (Item : Element_Type)
   with Global => (In_Out => State);
   --  Replace the sample.

   procedure Take (Item : out Element_Type; Status : out Queueing.Take_Status)
   with Global => (In_Out => State);
   --  Hand over the newest sample, or Null_Element when it was taken before.

end Ravenchart.Crossing_Samples;
