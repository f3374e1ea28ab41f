--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Real_Time;
with Ravenchart.Epochs;
with Ravenchart.Failures;

package body Ravenchart.Sporadic_Processors
  with SPARK_Mode
is
   use type Ada.Real_Time.Time;

   task body Processor is
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
         Releases.Start_Release (Due);
         Releases.Run (0, Due);
         Earliest := Due + Separation;
      end loop;
   end Processor;

end Ravenchart.Sporadic_Processors;
