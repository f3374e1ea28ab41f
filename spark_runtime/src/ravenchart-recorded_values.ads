--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One recorded value of a port or data item.
--
--  Guarantees   no state
--  Tasking      none
--  Timing       none

package Ravenchart.Recorded_Values
  with SPARK_Mode, Pure
is

   type Value_Record is record
      At_Time : Nanoseconds := 0;
      Element : Element_Id := 0;
      Value   : Number := 0;
   end record;
   --  At_Time counts from Epochs.Start. Value is an integer in the unit of its
   --  type, or the position of a literal; it holds each value of a model.

   Null_Record : constant Value_Record := (others => <>);
   --  Fills a place without a record.

end Ravenchart.Recorded_Values;
