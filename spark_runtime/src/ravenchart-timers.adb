--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Timers
  with SPARK_Mode
is
   ---------
   -- Arm --
   ---------

   procedure Arm
     (T          : out Timer;
      Executions : Execution_Count;
      Period     : Execution_Count := 0) is
   begin
      T :=
        (Armed     => True,
         Remaining => Remaining_Count (Executions),
         Period    => Period);
   end Arm;

   ------------
   -- Disarm --
   ------------

   procedure Disarm (T : out Timer) is
   begin
      T := (Armed => False, Remaining => 0, Period => 0);
   end Disarm;

   ----------
   -- Tick --
   ----------

   procedure Tick (Timers : in out Timer_Array) is
   begin
      for I in Timers'Range loop
         Timers (I) := Ticked (Timers (I));
         pragma Loop_Invariant
           (for all J in Timers'Range =>
              Timers (J) =
                (if J <= I then Ticked (Timers'Loop_Entry (J))
                 else Timers'Loop_Entry (J)));
      end loop;
   end Tick;

   --------------
   -- Take_Due --
   --------------

   procedure Take_Due (Timers : in out Timer_Array; Due : out Natural) is
   begin
      Due := 0;
      for I in Timers'Range loop
         if Is_Due (Timers (I))
           and then (Due = 0
                     or else Timers (I).Remaining < Timers (Due).Remaining)
         then
            Due := I;
         end if;
         pragma Loop_Invariant
           (if Due = 0
            then (for all J in Timers'First .. I => not Is_Due (Timers (J)))
            else Due in Timers'First .. I
                 and then Is_Due (Timers (Due))
                 and then (for all J in Timers'First .. I =>
                             (if Is_Due (Timers (J))
                              then Precedes (Timers, Due, J))));
      end loop;
      if Due > 0 then
         Timers (Due) := Expired (Timers (Due));
      end if;
   end Take_Due;

end Ravenchart.Timers;
