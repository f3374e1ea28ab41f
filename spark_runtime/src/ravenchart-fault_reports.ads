--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Every fault of a node is counted and traced here.
--
--  Guarantees   no state of its own
--  Tasking      any task that may call both actual procedures
--  Timing       the sum of both

with Ravenchart.Health;
with Ravenchart.Traces;

generic
   with procedure Record_Fault (Kind : Health.Fault_Kind);
   with procedure Note
     (Kind : Traces.Trace_Kind; Element : Element_Id; Value : Integer)
   is null;
   --  The trace; null where a node keeps none.
package Ravenchart.Fault_Reports
  with SPARK_Mode
is
   procedure Report (Kind : Health.Fault_Kind; Element : Element_Id);
   --  Count a fault of an element, and trace it.

end Ravenchart.Fault_Reports;
