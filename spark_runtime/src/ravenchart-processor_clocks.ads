--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Processor time of the calling task.
--
--  Guarantees   does not count time in which the task was preempted
--  Tasking      any task may call
--  Timing       one reading of the clock; a system call on a native target

with Ada.Real_Time;
with Ada.Task_Identification;

package Ravenchart.Processor_Clocks
  with SPARK_Mode
is
   procedure Read (Used : out Nanoseconds)
   with
     Global =>
       (Input => (Ada.Real_Time.Clock_Time,
                  Ada.Task_Identification.Tasking_State));
   --  Processor time the calling task has used since it was activated.

end Ravenchart.Processor_Clocks;
