--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Measures how long the host withholds the processor: one task above all
--  others wakes once per Period and records its lateness.
--
--  On a workstation or a virtual machine the kernel and the hypervisor take
--  time that no model includes. Nothing of the controller can delay this task,
--  so its lateness is the host's. cyclictest measures the same.
--
--  Guarantees   Read gives the largest lateness since the start
--  Analysis     one task record: T = Period, P = Probe_Priority
--  Assumptions  ASM-003, the clock never comes within one Period of Time_Last

with System;

generic
   Name : String;
   --  The name of the task in reports.
   Period : Positive_Nanoseconds;
   Probe_Priority : System.Priority;
   --  Above every other task of the program.
   Stack_Bytes : Positive;
package Ravenchart.Host_Probes
  with
    SPARK_Mode,
    Elaborate_Body,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   Given_Period   : constant Positive_Nanoseconds := Period;
   Given_Priority : constant System.Priority := Probe_Priority;
   --  The task as it runs, for comparison with a timing certificate.

   procedure Read (Longest : out Nanoseconds)
   with Global => (Input => State);
   --  The largest lateness seen.

end Ravenchart.Host_Probes;
