--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A value that an instance on another node publishes, as its readers see it:
--  the last value received. A value has to come within every Limit executions
--  of the reader that supervises it.
--
--  Guarantees   those of Calls; readers get a copy of one whole value
--  Tasking      any task up to Ceiling
--  Timing       the time to copy one Element_Type; never blocks
--  Analysis     one shared object, ceiling Ceiling

with System;
with Ravenchart.Calls;

generic
   type Element_Type is private;
   Initial : Element_Type;
   --  The value before the first one has come.
   Limit : Calls.Execution_Limit;
   --  Executions of the reader after which the value is too old.
   Ceiling : System.Any_Priority;
   --  At least the priority of every caller.
package Ravenchart.Remote_Reads
  with
    SPARK_Mode,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   procedure Put (Item : Element_Type)
   with Global => (In_Out => State);
   --  A value has come.

   procedure Tick (Status : out Calls.Wait_Status)
   with Global => (In_Out => State);
   --  One more execution of the reader has begun. Timed_Out: the value is too
   --  old; reported once until the next value.

   procedure Read (Item : out Element_Type)
   with Global => (Input => State);
   --  Copy the value out, of any age.

end Ravenchart.Remote_Reads;
