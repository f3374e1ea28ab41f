--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The faults at run time, typed so that a chart can react to them.
--
--  Guarantees   no state
--  Tasking      none
--  Timing       none

package Ravenchart.Health
  with SPARK_Mode, Pure
is

   type Fault_Kind is
     (Deadline_Miss,
      Overrun,
      Queue_Overflow,
      Stale_Input,
      Can_Error_Passive,
      Can_Bus_Off,
      Silence,
      Protection_Error);
   --  The faults that the runtime and the HAL can detect. The controller
   --  counts those of CAN itself (Read_Faults), and a report has those counts.

   type Fault_Counts is array (Fault_Kind) of Event_Count;
   --  How often each fault was recorded.

end Ravenchart.Health;
