--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Epochs;
with Ravenchart.Processor_Clocks;

package body Ravenchart.Measured_Releases
  with SPARK_Mode
is
   use type Ada.Real_Time.Time;

   procedure Start_Release (Due : Ada.Real_Time.Time) is
   begin
      Monitor.Record_Begin (Epochs.To_Nanoseconds (Due - Epochs.Start));
   end Start_Release;

   procedure Run (Release : Natural; Due : Ada.Real_Time.Time) is
      Times    : Monitor.Execution_Times := (others => 0);
      Before   : Nanoseconds;
      After    : Nanoseconds;
      Done     : Ada.Real_Time.Time;
      Response : Nanoseconds;
   begin
      for Activity in Activity_Id loop
         if Schedules.Runs_In (Table (Activity), Release) then
            Processor_Clocks.Read (Before);
            Execute (Activity);
            Processor_Clocks.Read (After);
            Times (Activity) := (if After > Before then After - Before else 0);
            On_Executed (Activity, Times (Activity));
         end if;
      end loop;
      Done     := Ada.Real_Time.Clock;
      Response := Epochs.To_Nanoseconds (Done - Due);
      Monitor.Record_Release
        (Response => Response,
         Missed   => Response > Deadline,
         Times    => Times);
      if Response > Deadline then
         On_Deadline_Miss;
      end if;
   end Run;

   procedure Observe (S : out Monitor.Statistics) is
   begin
      Monitor.Read (S);
   end Observe;

   procedure Observe_Progress (Seen : out Liveness.Progress) is
   begin
      Monitor.Read_Progress (Seen);
   end Observe_Progress;

end Ravenchart.Measured_Releases;
