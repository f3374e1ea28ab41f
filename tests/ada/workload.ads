--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Processors under test and the log of their activities.

with System;
with Ada.Real_Time;
with Ravenchart.Periodic_Processors;
with Ravenchart.Schedules;
with Ravenchart.Sporadic_Processors;
with Ravenchart.Waiting_Queues;

package Workload is

   type Job is (Each_Release, Each_Other);

   subtype Log_Index is Positive range 1 .. 1_000;

   type Entry_Record is record
      What    : Job := Each_Release;
      Value   : Natural := 0;
      At_Time : Ada.Real_Time.Time := Ada.Real_Time.Time_First;
   end record;

   type Entry_Array is array (Log_Index) of Entry_Record;

   protected type Log
     with Priority => System.Default_Priority + 8
   is
      procedure Add (Item : Entry_Record);
      --  Add an entry, unless the log is full.

      function Count return Natural;

      function Item (Index : Log_Index) return Entry_Record;

   private
      Entries : Entry_Array;
      Used    : Natural := 0;
   end Log;

   Cyclic_Log : Log;

   Late_Log : Log;

   Sporadic_Log : Log;

   Missed_Log : Log;

   Overrun_Log : Log;

   procedure Run_Cyclic (Activity : Job);

   procedure Run_Late (Activity : Job);

   procedure Wait_Sporadic;

   procedure Run_Sporadic (Activity : Job);

   procedure Note_Miss;

   procedure Note_Overrun (Activity : Job; Used : Ravenchart.Nanoseconds);
   --  Log an execution of more than 20 ms, with its time in ms as the value.

   procedure Ignore_Miss;

   type Job_Table is array (Job) of Ravenchart.Schedules.Slot;

   Jobs : constant Job_Table :=
     (Each_Release => (Divisor => 1, Phase => 0),
      Each_Other   => (Divisor => 2, Phase => 1));

   Period : constant := 10_000_000;

   package Cyclic is new Ravenchart.Periodic_Processors
     (Name             => "cyclic",
      Activity_Id      => Job,
      Table_Type       => Job_Table,
      Table            => Jobs,
      Cycle            => 2,
      Period           => Period,
      Offset           => 2_000_000,
      Deadline         => Period,
      Task_Priority    => System.Default_Priority + 4,
      Ceiling          => System.Default_Priority + 4,
      Stack_Bytes      => 65_536,
      Execute          => Run_Cyclic,
      On_Deadline_Miss => Ignore_Miss);

   package Late is new Ravenchart.Periodic_Processors
     (Name             => "late",
      Activity_Id      => Job,
      Table_Type       => Job_Table,
      Table            => Jobs,
      Cycle            => 2,
      Period           => Period,
      Offset           => 0,
      Deadline         => Period,
      Task_Priority    => System.Default_Priority + 3,
      Ceiling          => System.Default_Priority + 3,
      Stack_Bytes      => 65_536,
      Execute          => Run_Late,
      On_Deadline_Miss => Note_Miss,
      On_Executed      => Note_Overrun);

   package Requests is new Ravenchart.Waiting_Queues
     (Element_Type => Natural,
      Null_Element => 0,
      Capacity     => 8,
      Ceiling      => System.Default_Priority + 8);

   package Sporadic is new Ravenchart.Sporadic_Processors
     (Name               => "sporadic",
      Activity_Id        => Job,
      Minimum_Separation => 20_000_000,
      Deadline           => 20_000_000,
      Task_Priority      => System.Default_Priority + 5,
      Ceiling            => System.Default_Priority + 5,
      Stack_Bytes        => 65_536,
      Wait               => Wait_Sporadic,
      Execute            => Run_Sporadic,
      On_Deadline_Miss   => Ignore_Miss);

end Workload;
