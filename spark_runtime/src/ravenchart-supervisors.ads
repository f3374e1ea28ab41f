--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Liveness supervision of the processors of a node: one task, more urgent
--  than all that it supervises. Once per Period it looks whether each of them
--  has completed the releases that should have completed by then.
--
--  Guarantees   On_Silence is called once for each silent processor, within a
--               Period and the response time of this task. It is never called
--               for a processor that Look has not found silent. From the first
--               silence on the watchdog is not fed
--  Tasking      Read by any task up to Ceiling
--  Timing       each release, one look at each processor
--  Analysis     one task: T = Period, P = Task_Priority, C as declared; it
--               calls the monitor of each processor, and the operations of
--               On_Silence
--  Assumptions  ASM-003, the clock stays within the range of Time

with System;

generic
   type Processor_Id is (<>);
   --  The processors in the order of the looks: the most urgent first.
   Name : String;
   --  The name of the task in reports.
   Period : Positive_Nanoseconds;
   Patience : Nanoseconds;
   --  From the first silence until Give_Up: the time for an orderly end.
   Task_Priority : System.Priority;
   Ceiling : System.Any_Priority;
   --  At least the priority of every caller of Read.
   Stack_Bytes : Positive;
   with procedure Look
     (Item : Processor_Id; Elapsed : Nanoseconds; Is_Silent : out Boolean);
   --  Is a processor silent, at Elapsed from Epochs.Start?
   with procedure On_Silence (Item : Processor_Id);
   --  Called once for each processor that is silent.
   with procedure Feed_Watchdog;
   --  Called in each Period while no processor is silent.
   with procedure Give_Up;
   --  Called once per Period when Patience is over.
package Ravenchart.Supervisors
  with
    SPARK_Mode,
    Elaborate_Body,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   pragma Assert (Name'Length in 1 .. 128);

   Given_Period   : constant Positive_Nanoseconds := Period;
   Given_Priority : constant System.Priority := Task_Priority;
   --  The task as it runs, for comparison with a timing certificate.

   procedure Read (Fed : out Event_Count)
   with Global => (Input => State);
   --  How often the watchdog was fed.

end Ravenchart.Supervisors;
