--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The recorded values of one node, kept until the environment task writes
--  them out. They are apart from its trace: no value takes the place of a
--  record there.
--
--  Guarantees   values in the order in which they entered the lock; a value
--               that does not fit is rejected and counted
--  Tasking      any task up to Ceiling
--  Timing       constant; the clock is read before the lock
--  Analysis     one shared object, ceiling Ceiling

with System;
with Ada.Real_Time;
with Ravenchart.Epochs;
with Ravenchart.Queueing;
with Ravenchart.Recorded_Values;

generic
   Capacity : Queueing.Capacity_Type;
   Ceiling : System.Any_Priority;
   --  At least the priority of every caller.
package Ravenchart.Value_Buffers
  with
    SPARK_Mode,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   procedure Note (Value : Number; Element : Element_Id)
   with
     Global =>
       (Input  => (Epochs.Start, Ada.Real_Time.Clock_Time),
        In_Out => State);
   --  Add one value, stamped with the time since Start.

   procedure Take
     (Item   : out Recorded_Values.Value_Record;
      Status : out Queueing.Take_Status)
   with Global => (In_Out => State);
   --  Hand over the oldest value.

   function Lost return Event_Count
   with Volatile_Function, Global => State;
   --  How many values found the buffer full.

end Ravenchart.Value_Buffers;
