--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Epochs;
with Ravenchart.Failures;
with Ravenchart.Schedules;

procedure Ravenchart.Periodic_Loops
with SPARK_Mode
is
   Last    : constant Event_Count := Schedules.Last_Release (Offset, Period);
   Release : Event_Count := 0;
   Due     : Ada.Real_Time.Time;
begin
   Failures.Register (Name);
   loop
      pragma Loop_Invariant (Release <= Last);
      Due := Epochs.Instant (Schedules.Due (Offset, Period, Release));
      delay until Due;
      Run (Natural (Release mod Event_Count (Cycle)), Due);
      Release := Event_Count'Min (Next (Release), Last);
   end loop;
end Ravenchart.Periodic_Loops;
