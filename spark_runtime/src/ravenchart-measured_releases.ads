--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One release of a processor: run its activities, first to last, measure each
--  one, and check the deadline. Periodic and sporadic processors share this
--  unit.
--
--  Guarantees   activities run in the order of Activity_Id; a completion later
--               than Deadline after Due is counted and reported once. The
--               execution time of an activity is reported before the next one
--               runs
--  Tasking      Run by the one task of the processor, Observe by any task up
--               to Ceiling
--  Timing       the activities, and two clock readings for each

with System;
with Ada.Real_Time;
with Ravenchart.Liveness;
with Ravenchart.Monitors;
with Ravenchart.Schedules;

generic
   type Activity_Id is (<>);
   type Table_Type is array (Activity_Id) of Schedules.Slot;
   Table : Table_Type;
   --  The releases in which each activity runs.
   Deadline : Positive_Nanoseconds;
   Ceiling : System.Any_Priority;
   with procedure Execute (Activity : Activity_Id);
   --  Execute the activity once. Always returns, never suspends.
   with procedure On_Deadline_Miss;
   --  Called once for each release that completes after its deadline.
   pragma Warnings
     (GNATprove, Off, "subprogram ""On_Executed"" has no effect",
      Reason => "it is null where nobody wants to know");
   with procedure On_Executed
     (Activity : Activity_Id; Used : Nanoseconds) is null;
   --  Called after each activity, with its processor time.
package Ravenchart.Measured_Releases
  with SPARK_Mode
is
   package Monitor is new Monitors
     (Activity_Id => Activity_Id,
      Ceiling     => Ceiling);

   procedure Start_Release (Due : Ada.Real_Time.Time);
   --  Note the begin of a release of a sporadic processor that was due at Due.

   procedure Run (Release : Natural; Due : Ada.Real_Time.Time);
   --  Run the release that was due at Due and record it.

   procedure Observe (S : out Monitor.Statistics)
   with Global => (Input => Monitor.State);
   --  Copy the statistics up to now.

   procedure Observe_Progress (Seen : out Liveness.Progress)
   with Global => (Input => Monitor.State);
   --  Copy the progress of the processor.

end Ravenchart.Measured_Releases;
