--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Bounded queue from a task of one core to a task of another: a ring with one
--  producer and one consumer (L. Lamport, Proving the correctness of
--  multiprocess programs, IEEE TSE 3(2), 1977).
--
--  Guarantees   strict order, none twice; an element that does not fit is
--               rejected and counted. proofs/interleavings proves it over
--               every interleaving
--  Tasking      one task puts, one task takes; neither ever waits
--  Timing       the time to copy one Element_Type, and three atomic accesses
--  Analysis     no shared object: no ceiling, no blocking
--  Assumptions  ASM-023, atomic objects order the accesses of two cores

with Ravenchart.Queueing;

generic
   type Element_Type is private;
   Null_Element : Element_Type;
   --  The element that Take returns when Empty.
   Capacity : Queueing.Capacity_Type;
package Ravenchart.Crossing_Queues
  with
    SPARK_Mode,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   procedure Put (Item : Element_Type; Status : out Queueing.Put_Status)
   with Global => (In_Out => State);
   --  Queue Item; a full queue rejects and counts it.

   procedure Take (Item : out Element_Type; Status : out Queueing.Take_Status)
   with Global => (In_Out => State);
   --  Hand over the oldest element, or Null_Element when Empty.

   function Lost return Event_Count
   with Volatile_Function, Global => State;
   --  How many elements were rejected; it stays at 2**31 - 1.

end Ravenchart.Crossing_Queues;
