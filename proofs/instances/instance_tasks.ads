--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One periodic and one sporadic processor with their supervisor. With
--  Instance_Store and Instance_Bus they are a small controller, as generated
--  from a model.

with System;
with Ada.Real_Time;
with Instance_Bus;
with Instance_Store;
with Ravenchart.Epochs;
with Ravenchart.Failures;
with Ravenchart.Host_Probes;
with Ravenchart.Periodic_Processors;
with Ravenchart.Schedules;
with Ravenchart.Sporadic_Processors;
with Ravenchart.Supervisors;

package Instance_Tasks
  with
    SPARK_Mode,
    Abstract_State => (Periodic_State, Sporadic_State)
is
   type Job is (Sense, Control, Report);
   --  The activities of the periodic processor.

   type Job_Table is array (Job) of Ravenchart.Schedules.Slot;
   --  The releases in which each activity runs.

   Jobs : constant Job_Table :=
     (Sense   => (Divisor => 1, Phase => 0),
      Control => (Divisor => 2, Phase => 0),
      Report  => (Divisor => 4, Phase => 3));
   --  Three periods: 10, 20 and 40 ms.

   procedure Run_Job (Activity : Job)
   with
     Global =>
       (Input  => (Ravenchart.Epochs.Start,
                   Ada.Real_Time.Clock_Time),
        In_Out => (Periodic_State,
                   Instance_Store.Rejecting_Queue.State,
                   Instance_Store.Dropping_Queue.State,
                   Instance_Store.Board.State,
                   Instance_Store.Trace.State,
                   Instance_Store.Counters.State,
                   Instance_Bus.Controller.State,
                   Instance_Bus.Controller.Wake_Up));
   --  Run one activity of the periodic processor.

   type Service is (Receive);
   --  The activity of the sporadic processor.

   procedure Await_Frame
   with
     Global =>
       (Output => Sporadic_State,
        In_Out => (Instance_Bus.Controller.State,
                   Instance_Bus.Controller.Wake_Up));
   --  Suspend until a frame has come.

   procedure Run_Service (Activity : Service)
   with
     Global =>
       (Input  => Sporadic_State,
        In_Out => (Instance_Store.Rejecting_Queue.State,
                   Instance_Store.Counters.State));
   --  Run the activity of the sporadic processor.

   procedure Note_Miss
   with Global => (In_Out => Instance_Store.Counters.State);
   --  A deadline was missed.

   procedure Note_Overrun (Activity : Job; Used : Ravenchart.Nanoseconds)
   with Global => (In_Out => Instance_Store.Counters.State);
   --  An activity took so much processor time, which may be too much.

   package Cyclic is new Ravenchart.Periodic_Processors
     (Name             => "cyclic",
      Activity_Id      => Job,
      Table_Type       => Job_Table,
      Table            => Jobs,
      Cycle            => 4,
      Period           => 10_000_000,
      Offset           => 1_000_000,
      Deadline         => 10_000_000,
      Task_Priority    => System.Default_Priority + 4,
      Ceiling          => System.Default_Priority + 7,
      Stack_Bytes      => 65_536,
      Execute          => Run_Job,
      On_Deadline_Miss => Note_Miss,
      On_Executed      => Note_Overrun);

   package Served is new Ravenchart.Sporadic_Processors
     (Name               => "served",
      Activity_Id        => Service,
      Minimum_Separation => 2_000_000,
      Deadline           => 2_000_000,
      Task_Priority      => System.Default_Priority + 5,
      Ceiling            => System.Default_Priority + 7,
      Stack_Bytes        => 65_536,
      Wait               => Await_Frame,
      Execute            => Run_Service,
      On_Deadline_Miss   => Note_Miss);

   package Probe is new Ravenchart.Host_Probes
     (Name           => "probe",
      Period         => 1_000_000,
      Probe_Priority => System.Default_Priority + 10,
      Stack_Bytes    => 65_536);

   type Watched is (Watched_Served, Watched_Cyclic);
   --  The processors, the most urgent first.

   procedure Look
     (Item      : Watched;
      Elapsed   : Ravenchart.Nanoseconds;
      Is_Silent : out Boolean);
   --  Is the processor silent?

   procedure Note_Silence (Item : Watched)
   with
     Global =>
       (In_Out => (Instance_Store.Counters.State,
                   Ravenchart.Failures.State));
   --  The processor is silent.

   package Supervisor is new Ravenchart.Supervisors
     (Processor_Id  => Watched,
      Name          => "supervisor",
      Period        => 10_000_000,
      Patience      => 1_000_000_000,
      Task_Priority => System.Default_Priority + 7,
      Ceiling       => System.Default_Priority + 7,
      Stack_Bytes   => 65_536,
      Look          => Look,
      On_Silence    => Note_Silence,
      Feed_Watchdog => Ravenchart.Failures.Feed_Watchdog,
      Give_Up       => Ravenchart.Failures.Give_Up);

end Instance_Tasks;
