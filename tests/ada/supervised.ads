--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Processors that fall silent, each in its own way, and one that does not;
--  their supervisor and its findings.

with Ada.Command_Line;
with System;
with Ravenchart.Failures;
with Ravenchart.Periodic_Processors;
with Ravenchart.Schedules;
with Ravenchart.Sporadic_Processors;
with Ravenchart.Supervisors;
with Ravenchart.Waiting_Queues;

package Supervised is

   type Job is (Only);

   type Job_Table is array (Job) of Ravenchart.Schedules.Slot;

   Jobs : constant Job_Table := (Only => (Divisor => 1, Phase => 0));

   Period : constant := 10_000_000;
   Limit  : constant := 60_000_000;
   --  The deadline, and a margin of 50 ms.

   Limit_Of_Healthy : constant := 500_000_000;
   --  The healthy processor is not silent unless the machine delays it for so
   --  long.

   Patience : constant Ravenchart.Nanoseconds :=
     (if Ada.Command_Line.Argument_Count > 0 then 1_500_000_000
      else 300_000_000_000);
   --  Only a main program that has to wait is given up: on a busy machine the
   --  other one may be late as well.

   type Processor is (Watch_Healthy, Watch_Served, Watch_Stuck);

   type Finding is record
      Times  : Natural := 0;
      Found  : Ravenchart.Nanoseconds := 0;
      Before : Ravenchart.Event_Count := 0;
   end record;
   --  How often a processor was found silent; the time, and the number of its
   --  completed releases then.

   type Finding_Table is array (Processor) of Finding;

   protected Findings
     with Priority => System.Default_Priority + 8
   is
      procedure Add (Item : Processor; Seen : Finding);

      function All_Of_Them return Finding_Table;

   private
      Table : Finding_Table;
   end Findings;

   procedure Run_Healthy (Activity : Job) is null;

   procedure Run_Stuck (Activity : Job);
   --  Its sixth execution lasts for ever.

   procedure Wait_For_Request;

   procedure Run_Served (Activity : Job);
   --  Its second execution waits for ever.

   procedure Ignore_Miss is null;

   package Healthy is new Ravenchart.Periodic_Processors
     (Name             => "healthy",
      Activity_Id      => Job,
      Table_Type       => Job_Table,
      Table            => Jobs,
      Cycle            => 1,
      Period           => Period,
      Offset           => 0,
      Deadline         => Period,
      Task_Priority    => System.Default_Priority + 5,
      Ceiling          => System.Default_Priority + 7,
      Stack_Bytes      => 65_536,
      Execute          => Run_Healthy,
      On_Deadline_Miss => Ignore_Miss);

   package Stuck is new Ravenchart.Periodic_Processors
     (Name             => "stuck",
      Activity_Id      => Job,
      Table_Type       => Job_Table,
      Table            => Jobs,
      Cycle            => 1,
      Period           => Period,
      Offset           => 2_000_000,
      Deadline         => Period,
      Task_Priority    => System.Default_Priority + 3,
      Ceiling          => System.Default_Priority + 7,
      Stack_Bytes      => 65_536,
      Execute          => Run_Stuck,
      On_Deadline_Miss => Ignore_Miss);

   package Requests is new Ravenchart.Waiting_Queues
     (Element_Type => Natural,
      Null_Element => 0,
      Capacity     => 8,
      Ceiling      => System.Default_Priority + 8);

   package Served is new Ravenchart.Sporadic_Processors
     (Name               => "served",
      Activity_Id        => Job,
      Minimum_Separation => Period,
      Deadline           => Period,
      Task_Priority      => System.Default_Priority + 4,
      Ceiling            => System.Default_Priority + 7,
      Stack_Bytes        => 65_536,
      Wait               => Wait_For_Request,
      Execute            => Run_Served,
      On_Deadline_Miss   => Ignore_Miss);

   procedure Look
     (Item      : Processor;
      Elapsed   : Ravenchart.Nanoseconds;
      Is_Silent : out Boolean);

   procedure Note (Item : Processor);

   procedure Feed;

   package Supervisor is new Ravenchart.Supervisors
     (Processor_Id  => Processor,
      Name          => "supervisor",
      Period        => Period,
      Patience      => Patience,
      Task_Priority => System.Default_Priority + 7,
      Ceiling       => System.Default_Priority + 7,
      Stack_Bytes   => 65_536,
      Look          => Look,
      On_Silence    => Note,
      Feed_Watchdog => Feed,
      Give_Up       => Ravenchart.Failures.Give_Up);

end Supervised;
