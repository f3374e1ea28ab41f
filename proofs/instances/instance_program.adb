--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The environment task of a host: it writes the trace until a signal ends the
--  run, and then the summary.

with System;
with Ada.Real_Time;
with Four_Slot_Steps;
pragma Unreferenced (Four_Slot_Steps);
with Instance_Authentication;
pragma Unreferenced (Instance_Authentication);
with Instance_Bus;
with Instance_Clocks;
pragma Unreferenced (Instance_Clocks);
with Instance_Iso_Tp;
pragma Unreferenced (Instance_Iso_Tp);
with Instance_Protection;
pragma Unreferenced (Instance_Protection);
with Instance_Simulator;
pragma Unreferenced (Instance_Simulator);
with Instance_Store;
with Instance_Tasks;
with Instance_Transmissions;
pragma Unreferenced (Instance_Transmissions);
with Ravenchart.Can;
with Ravenchart.Can.Fault_Notices;
with Ravenchart.Health;
with Ravenchart.Hosts;
with Ravenchart.Queueing;
with Ravenchart.Traces;
with Ring_Steps;
pragma Unreferenced (Ring_Steps);

procedure Instance_Program
  with SPARK_Mode, Priority => System.Priority'First
is
   use type Ada.Real_Time.Time;
   use type Ravenchart.Element_Id;
   use type Ravenchart.Queueing.Take_Status;

   Poll   : constant Ada.Real_Time.Time_Span :=
     Ada.Real_Time.Milliseconds (20);
   Next   : Ada.Real_Time.Time := Ada.Real_Time.Clock;
   Ending : Boolean;
   Item   : Ravenchart.Traces.Trace_Record;
   Status : Ravenchart.Queueing.Take_Status;
   Lost   : Ravenchart.Event_Count;
   Counts : Ravenchart.Health.Fault_Counts;
   Cyclic : Instance_Tasks.Cyclic.Statistics;
   Served : Instance_Tasks.Served.Statistics;
   Bus    : Ravenchart.Can.Counters;
   Faults : Ravenchart.Can.Fault_Notices.Fault_Log;
   Late   : Ravenchart.Nanoseconds;
   Fed    : Ravenchart.Event_Count;
   Fill   : Ravenchart.Queueing.Fill;
begin
   Ravenchart.Hosts.Start;
   loop
      Ending := Ravenchart.Hosts.Stop_Requested;
      loop
         Instance_Store.Trace.Take (Item, Status);
         exit when Status = Ravenchart.Queueing.Empty;
         Ravenchart.Hosts.Put_Trace (Item);
      end loop;
      exit when Ending;
      Instance_Bus.Controller.Request_Recovery;
      Next := Next + Poll;
      delay until Next;
   end loop;
   Ravenchart.Hosts.Put_Now;
   Instance_Tasks.Cyclic.Observe (Cyclic);
   Ravenchart.Hosts.Put_Processor
     (1, Cyclic.Releases, Cyclic.Misses, Cyclic.Worst_Response,
      Cyclic.Last_Response);
   for Job in Instance_Tasks.Job loop
      Ravenchart.Hosts.Put_Activity
        (Instance_Tasks.Job'Pos (Job) + 10, Cyclic.Worst_Execution (Job));
   end loop;
   Instance_Tasks.Served.Observe (Served);
   Ravenchart.Hosts.Put_Processor
     (2, Served.Releases, Served.Misses, Served.Worst_Response,
      Served.Last_Response);
   Instance_Store.Dropping_Queue.Read_Fill (Fill);
   Ravenchart.Hosts.Put_Queue (3, Fill);
   Instance_Store.Counters.Read (Counts);
   Instance_Bus.Controller.Read_Faults (Faults);
   Counts (Ravenchart.Health.Can_Bus_Off) := Faults.Off_Entries;
   for Kind in Ravenchart.Health.Fault_Kind loop
      Ravenchart.Hosts.Put_Fault_Count (Kind, Counts (Kind));
   end loop;
   Lost := Instance_Store.Trace.Lost;
   Ravenchart.Hosts.Put_Lost ("trace", Lost);
   Instance_Bus.Controller.Read_Counters (Bus);
   Ravenchart.Hosts.Put_Lost ("can", Bus.Lost_In);
   Instance_Tasks.Probe.Read (Late);
   Ravenchart.Hosts.Put_Host_Latency (Late);
   Instance_Tasks.Supervisor.Read (Fed);
   Ravenchart.Hosts.Put_Feeds (Fed);
   Ravenchart.Hosts.Finish (Success => True);
end Instance_Program;
