--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Fault_Reports
  with SPARK_Mode
is
   ------------
   -- Report --
   ------------

   procedure Report (Kind : Health.Fault_Kind; Element : Element_Id) is
   begin
      Record_Fault (Kind);
      Note (Traces.Fault, Element, Health.Fault_Kind'Pos (Kind));
   end Report;

end Ravenchart.Fault_Reports;
