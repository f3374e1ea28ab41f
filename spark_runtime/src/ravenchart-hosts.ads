--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The environment of a controller: requests to stop, its report, and its end.
--
--  Guarantees   a report that cannot be written never disturbs the controller:
--               it then ends early
--  Tasking      the environment task only, at the lowest priority; gnatprove
--               refuses a second task, since the state is not synchronous
--  Timing       not bounded: it may wait for a disk or a serial line
--  Assumptions  ASM-002, the body of Hosts.Services
--
--  On a Unix host the environment variable RAVENCHART_TRACE names the file of
--  the report; without it there is none. A board writes the report to its
--  serial line. Times are in nanoseconds. A board repeats its M line. END is
--  the last line. The lines:
--
--     E clock           the real-time clock of the machine at Epochs.Start
--     M digest          of the model from which the program was generated
--     T time kind element value
--     V time element value
--                       a recorded value (Value_Lines)
--     P processor releases misses worst_response last_response
--     A activity worst_execution
--     Q region waiting highest
--                       an event queue
--     H kind count      a kind of fault
--     L what count      losses of one kind
--     W host_latency
--     N now             the time at which the statistics were read
--     O time            when another core read the lines that follow
--     F feeds           of the watchdog
--     END

with Ada.Real_Time;
with Ravenchart.Epochs;
with Ravenchart.Failures;
with Ravenchart.Health;
with Ravenchart.Queueing;
with Ravenchart.Traces;

package Ravenchart.Hosts
  with
    SPARK_Mode,
    Abstract_State =>
      (Process with External => (Async_Readers, Async_Writers,
                                 Effective_Writes)),
    Initializes    => Process
is
   procedure Start
   with Global => (Input => Epochs.Start, In_Out => Process);
   --  Accept requests to stop (SIGTERM and SIGINT on a Unix host), and begin
   --  the report. A host without real-time priorities causes a warning.

   function Stop_Requested return Boolean
   with Volatile_Function, Global => (Process, Failures.State);
   --  Is there a request to end the controller, or a failure?

   procedure Put_Model (Digest : String)
   with
     Global => (In_Out => Process),
     Pre    => Digest'Length in 1 .. 80;
   --  Write an M line; Digest is one word.

   procedure Put_Trace (Item : Traces.Trace_Record)
   with Global => (In_Out => Process);
   --  Write a T line.

   procedure Put_Processor
     (Id             : Element_Id;
      Releases       : Event_Count;
      Misses         : Event_Count;
      Worst_Response : Nanoseconds;
      Last_Response  : Nanoseconds)
   with Global => (In_Out => Process);
   --  Write a P line.

   procedure Put_Queue (Id : Element_Id; Found : Queueing.Fill)
   with Global => (In_Out => Process);
   --  Write a Q line.

   procedure Put_Activity (Id : Element_Id; Worst_Execution : Nanoseconds)
   with Global => (In_Out => Process);
   --  Write an A line.

   procedure Put_Fault_Count (Kind : Health.Fault_Kind; Count : Event_Count)
   with Global => (In_Out => Process);
   --  Write an H line.

   procedure Put_Lost (What : String; Count : Event_Count)
   with
     Global => (In_Out => Process),
     Pre    => What'Length in 1 .. 80;
   --  Write an L line; What is one word.

   procedure Put_Host_Latency (Longest : Nanoseconds)
   with Global => (In_Out => Process);
   --  Write a W line: the longest time the host withheld the processor.

   procedure Put_Now
   with
     Global =>
       (Input  => (Epochs.Start, Ada.Real_Time.Clock_Time),
        In_Out => Process);
   --  Write an N line: the lines that follow were read no earlier.

   procedure Put_Other_Core (Looked : Nanoseconds)
   with Global => (In_Out => Process);
   --  Write an O line: another core read the lines that follow, no earlier
   --  than Looked, which counts from Epochs.Start.

   procedure Put_Feeds (Count : Event_Count)
   with Global => (In_Out => Process);
   --  Write an F line: how often the watchdog was fed.

   procedure Finish (Success : Boolean)
   with Global => (In_Out => (Process, Failures.State));
   --  Write the END line and the reasons of failures, and end the program:
   --  status 0 on Success where there is no failure, else 1.

end Ravenchart.Hosts;
