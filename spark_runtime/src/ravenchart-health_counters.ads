--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The health record of one node.
--
--  Guarantees   counts stay at their last value instead of wrapping
--  Tasking      any task up to Ceiling
--  Timing       constant, never blocks
--  Analysis     one shared object, ceiling Ceiling

with System;
with Ravenchart.Health;

generic
   Ceiling : System.Any_Priority;
   --  At least the priority of every caller.
package Ravenchart.Health_Counters
  with
    SPARK_Mode,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   procedure Record_Fault (Kind : Health.Fault_Kind)
   with Global => (In_Out => State);
   --  Count one more fault of this kind.

   procedure Read (Counts : out Health.Fault_Counts)
   with Global => (Input => State);
   --  Copy all counts, taken at one instant.

end Ravenchart.Health_Counters;
