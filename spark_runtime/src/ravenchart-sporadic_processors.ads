--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Sporadic command processor: one task that runs its activities once for each
--  release that Wait returns.
--
--  Guarantees   two releases are never due closer than Minimum_Separation; a
--               release that comes earlier is due when the separation is over
--  Tasking      Observe and Observe_Progress by any task up to Ceiling
--  Timing       each release, all activities
--  Analysis     one task: T = Minimum_Separation, D = Deadline,
--               P = Task_Priority, C = sum of the WCETs. A response counts
--               from the return of Wait or from the end of the separation
--  Assumptions  ASM-003, the clock stays within the range of Time

with System;
with Ravenchart.Liveness;
with Ravenchart.Measured_Releases;
with Ravenchart.Schedules;

generic
   Name : String;
   --  The name of the task in reports.
   type Activity_Id is (<>);
   Minimum_Separation : Positive_Nanoseconds;
   Deadline : Positive_Nanoseconds;
   Task_Priority : System.Priority;
   Ceiling : System.Any_Priority;
   --  At least Task_Priority, and that of every caller of Observe.
   Stack_Bytes : Positive;
   with procedure Wait;
   --  Suspends until the next release.
   with procedure Execute (Activity : Activity_Id);
   --  Run one activity once. Always returns, never suspends.
   with procedure On_Deadline_Miss;
   --  Called once for each release that completes after its deadline.
   pragma Warnings
     (GNATprove, Off, "subprogram ""On_Executed"" has no effect",
      Reason => "it is null where nobody wants to know");
   with procedure On_Executed
     (Activity : Activity_Id; Used : Nanoseconds) is null;
   --  Called after each activity, with its processor time.
package Ravenchart.Sporadic_Processors
  with SPARK_Mode, Elaborate_Body
is
   pragma Assert (Name'Length in 1 .. 128);

   Given_Separation : constant Positive_Nanoseconds := Minimum_Separation;
   Given_Deadline   : constant Positive_Nanoseconds := Deadline;
   Given_Priority   : constant System.Priority := Task_Priority;
   --  The task as it runs, for comparison with a timing certificate.

   type Table_Type is array (Activity_Id) of Schedules.Slot;
   --  A table of the form that a release needs.

   Table : constant Table_Type := (others => (Divisor => 1, Phase => 0));
   --  Every activity runs in every release.

   package Releases is new Measured_Releases
     (Activity_Id      => Activity_Id,
      Table_Type       => Table_Type,
      Table            => Table,
      Deadline         => Deadline,
      Ceiling          => Ceiling,
      Execute          => Execute,
      On_Deadline_Miss => On_Deadline_Miss,
      On_Executed      => On_Executed);

   subtype Statistics is Releases.Monitor.Statistics;
   --  Releases, Misses, Last_Response, Worst_Response and Worst_Execution.

   procedure Observe (S : out Statistics) renames Releases.Observe;
   --  Copy the statistics up to now.

   procedure Observe_Progress (Seen : out Liveness.Progress)
   renames Releases.Observe_Progress;
   --  Copy the progress of the processor.

private

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Processor
   with Priority => Task_Priority, Storage_Size => Stack_Bytes;
   --  Never ends. Its Global follows, instance by instance, from the three
   --  actual procedures.

end Ravenchart.Sporadic_Processors;
