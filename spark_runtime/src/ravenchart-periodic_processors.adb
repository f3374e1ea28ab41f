--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Real_Time;
with Ravenchart.Epochs;
with Ravenchart.Failures;

package body Ravenchart.Periodic_Processors
  with SPARK_Mode
is
   task body Processor is
      Last    : constant Event_Count :=
        Schedules.Last_Release (Offset, Period);
      Release : Event_Count := 0;
      Due     : Ada.Real_Time.Time;
   begin
      Failures.Register (Name);
      loop
         pragma Loop_Invariant (Release <= Last);
         Due := Epochs.Instant (Schedules.Due (Offset, Period, Release));
         delay until Due;
         Releases.Run (Natural (Release mod Event_Count (Cycle)), Due);
         Release := Event_Count'Min (Next (Release), Last);
      end loop;
   end Processor;

end Ravenchart.Periodic_Processors;
