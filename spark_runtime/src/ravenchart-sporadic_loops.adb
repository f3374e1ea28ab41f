--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Epochs;
with Ravenchart.Failures;

procedure Ravenchart.Sporadic_Loops
with SPARK_Mode
is
   use type Ada.Real_Time.Time;

   Separation : constant Ada.Real_Time.Time_Span :=
     Epochs.To_Span (Minimum_Separation);
   Earliest   : Ada.Real_Time.Time := Epochs.Start;
   Due        : Ada.Real_Time.Time;
begin
   Failures.Register (Name);
   loop
      Wait;
      Due := Ada.Real_Time.Clock;
      if Due < Earliest then
         Due := Earliest;
         delay until Due;
      end if;
      Start_Release (Due);
      Run (0, Due);
      Earliest := Due + Separation;
   end loop;
end Ravenchart.Sporadic_Loops;
