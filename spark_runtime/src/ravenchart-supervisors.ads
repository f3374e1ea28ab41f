--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Liveness supervision of the processors of a node: one task, more urgent
--  than all that it supervises, looks once per Period whether each of them
--  has completed what it should have completed by then.
--
--  Guarantees   On_Silence is called once for each processor that is silent,
--               within a Period and the response time of this task; never for
--               one that Look has not found silent; from then on the watchdog
--               is not fed
--  Tasking      Read by any task up to Ceiling
--  Timing       each release, one look at each processor
--  Analysis     one task: T = Period, P = Task_Priority, C as declared; it
--               calls the monitor of each processor, and what On_Silence
--               calls
--  Assumptions  ASM-003, the clock stays within the range of Time

with System;

generic
   type Processor_Id is (<>);
   --  In the order of the looks: the most urgent processor first.
   Name : String;
   --  Of the task, where it is reported.
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
   --  Called in each Period, as long as none is.
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
   --  The task as it runs, for a timing certificate to be compared with.

   procedure Read (Fed : out Event_Count)
   with Global => (Input => State);
   --  How often the watchdog was fed.

end Ravenchart.Supervisors;
