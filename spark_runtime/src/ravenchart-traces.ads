--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One line of the execution trace.
--
--  Guarantees   no state
--  Tasking      none
--  Timing       none

package Ravenchart.Traces
  with SPARK_Mode, Pure
is

   type Trace_Kind is
     (Sent, Arrived, Handled, Raised, Activity, Transition, State, Fault);
   --  The kind of occurrence at the element.

   type Trace_Record is record
      At_Time : Nanoseconds := 0;
      Kind    : Trace_Kind := State;
      Element : Element_Id := 0;
      Value   : Integer := 0;
   end record;
   --  At_Time counts from Epochs.Start; Value is a detail of this Kind.

   Null_Record : constant Trace_Record := (others => <>);
   --  Fills a place without a record.

end Ravenchart.Traces;
