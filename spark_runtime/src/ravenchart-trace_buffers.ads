--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The trace of one node, kept until the environment task writes it out.
--
--  Guarantees   records in the order in which they entered the lock; a record
--               that does not fit is rejected and counted
--  Tasking      any task up to Ceiling
--  Timing       constant; the clock is read before the lock
--  Analysis     one shared object, ceiling Ceiling

with System;
with Ada.Real_Time;
with Ravenchart.Epochs;
with Ravenchart.Queueing;
with Ravenchart.Traces;

generic
   Capacity : Queueing.Capacity_Type;
   Ceiling : System.Any_Priority;
   --  At least the priority of every caller.
package Ravenchart.Trace_Buffers
  with
    SPARK_Mode,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   procedure Note
     (Kind    : Traces.Trace_Kind;
      Element : Element_Id;
      Value   : Integer)
   with
     Global =>
       (Input  => (Epochs.Start, Ada.Real_Time.Clock_Time),
        In_Out => State);
   --  Add one record, stamped with the time since Start.

   procedure Take
     (Item : out Traces.Trace_Record; Status : out Queueing.Take_Status)
   with Global => (In_Out => State);
   --  Hand over the oldest record.

   function Lost return Event_Count
   with Volatile_Function, Global => State;
   --  How many records found the buffer full.

end Ravenchart.Trace_Buffers;
