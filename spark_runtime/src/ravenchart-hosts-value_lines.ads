--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Recorded values in the report of a controller: V time element value.
--
--  Guarantees   those of Hosts
--  Tasking      the environment task only
--  Timing       not bounded: it may wait for a disk or a serial line

with Ravenchart.Recorded_Values;

package Ravenchart.Hosts.Value_Lines
  with SPARK_Mode
is
   procedure Put (Item : Recorded_Values.Value_Record)
   with Global => (In_Out => Process);
   --  Write a V line.

end Ravenchart.Hosts.Value_Lines;
