--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Periodic command processor: one task that runs its activity table once in
--  every Period.
--
--  Guarantees   release K is due at the first tick of the clock at or after
--               Epochs.Start + Offset + K * Period: no drift; a late release
--               is run late, never dropped or merged
--  Tasking      Observe and Observe_Progress by any task up to Ceiling
--  Timing       each release, the activities whose slot names it
--  Analysis     one task: T = Period, D = Deadline, O = Offset,
--               P = Task_Priority, C = the largest sum of WCETs over the
--               releases of one Cycle
--  Assumptions  ASM-003, the clock stays within the range of Time

with System;
with Ravenchart.Liveness;
with Ravenchart.Measured_Releases;
with Ravenchart.Schedules;

generic
   Name : String;
   --  The name of the task in reports.
   type Activity_Id is (<>);
   type Table_Type is array (Activity_Id) of Schedules.Slot;
   Table : Table_Type;
   --  The releases in which each activity runs; they run in the order of
   --  Activity_Id.
   Cycle : Positive;
   --  Releases after which the table repeats: a multiple of each divisor.
   Period : Positive_Nanoseconds;
   Offset : Nanoseconds;
   Deadline : Positive_Nanoseconds;
   Task_Priority : System.Priority;
   Ceiling : System.Any_Priority;
   --  At least Task_Priority, and that of every caller of Observe.
   Stack_Bytes : Positive;
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
package Ravenchart.Periodic_Processors
  with SPARK_Mode, Elaborate_Body
is
   pragma Assert (Name'Length in 1 .. 128);
   pragma Assert (for all Slot of Table => Schedules.Fits (Slot, Cycle));

   Given_Table    : constant Table_Type := Table;
   Given_Period   : constant Positive_Nanoseconds := Period;
   Given_Offset   : constant Nanoseconds := Offset;
   Given_Deadline : constant Positive_Nanoseconds := Deadline;
   Given_Priority : constant System.Priority := Task_Priority;
   --  The task as it runs, for comparison with a timing certificate.

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
   --  Never ends. Its Global follows, instance by instance, from the two
   --  actual procedures.

end Ravenchart.Periodic_Processors;
