--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The work of a periodic processor's task: wait until each release is due,
--  and run it. Periodic_Processors has a task around it. A program for several
--  cores declares the task itself, since its CPU has to be static (RM D.7,
--  No_Dynamic_CPU_Assignment).
--
--  Guarantees   release K is due at the first tick of the clock at or after
--               Epochs.Start + Offset + K * Period: no drift; a late release
--               is run late, never dropped or merged
--  Tasking      called by one task, once; it never returns
--  Timing       the sum of the releases
--  Assumptions  ASM-003, the clock stays within the range of Time

with Ada.Real_Time;

generic
   Name : String;
   --  The name of the task in reports.
   Cycle : Positive;
   --  Releases after which the table repeats.
   Period : Positive_Nanoseconds;
   Offset : Nanoseconds;
   with procedure Run (Release : Natural; Due : Ada.Real_Time.Time);
   --  Run one release, by its number in the cycle.
procedure Ravenchart.Periodic_Loops
with SPARK_Mode, No_Return;
