--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One processor of two rows: Count in every release, Show in every fifth.

with Ravenchart.Blackboards;
with Ravenchart.Periodic_Processors;
with Ravenchart.Schedules;

package Counting with SPARK_Mode is
   type Row is (Count, Show);
   type Row_Table is array (Row) of Ravenchart.Schedules.Slot;

   package Shown is new Ravenchart.Blackboards
     (Ravenchart.Event_Count, Initial => 0, Ceiling => 60);

   procedure Execute (Item : Row);
   procedure On_Deadline_Miss is null;

   package Processor is new Ravenchart.Periodic_Processors
     ("counting", Row, Row_Table,
      Table => (Count => (1, 0), Show => (5, 4)), Cycle => 5,
      Period => 10_000_000, Offset => 0, Deadline => 10_000_000,
      Task_Priority => 60, Ceiling => 60, Stack_Bytes => 32_768,
      Execute => Execute, On_Deadline_Miss => On_Deadline_Miss);
end Counting;
