--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The work of a sporadic processor's task: wait for each release, and run it;
--  as Periodic_Loops.
--
--  Guarantees   two releases are never due closer than Minimum_Separation; a
--               release that comes earlier is due when the separation is over
--  Tasking      called by one task, once; it never returns
--  Timing       the sum of the releases
--  Assumptions  ASM-003, the clock stays within the range of Time

with Ada.Real_Time;

generic
   Name : String;
   --  The name of the task in reports.
   Minimum_Separation : Positive_Nanoseconds;
   with procedure Wait;
   --  Suspends until the next release.
   with procedure Start_Release (Due : Ada.Real_Time.Time);
   --  Note the begin of a release.
   with procedure Run (Release : Natural; Due : Ada.Real_Time.Time);
   --  Run one release; each has the number 0.
procedure Ravenchart.Sporadic_Loops
with SPARK_Mode, No_Return;
