--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Fault_Plans
  with SPARK_Mode
is

   ----------
   -- Draw --
   ----------

   procedure Draw
     (P : in out Plan; Now : Nanoseconds; Fault : out Bus_Faults.Fault) is
   begin
      P.Frames := Next (P.Frames);
      Fault := Bus_Faults.No_Fault;
      for I in 1 .. P.Count loop
         if P.Listed (I).Frame = P.Frames then
            Fault := P.Listed (I).Fault;
            return;
         end if;
         pragma Loop_Invariant
           (for all J in 1 .. I => P.Listed (J).Frame /= P.Frames);
      end loop;
      if P.Separation > 0 and then Now >= P.Not_Before then
         P.Seed := Next (P.Seed);
         Fault :=
           (Kind     => Bus_Faults.Disturbed_Bit,
            Position => Drawn_Position (P.Seed),
            others   => <>);
      end if;
   end Draw;

   ----------
   -- Note --
   ----------

   procedure Note (P : in out Plan; Struck : Nanoseconds) is
   begin
      P.Not_Before :=
        (if Struck <= Nanoseconds'Last - P.Separation
         then Struck + P.Separation
         else Nanoseconds'Last);
   end Note;

end Ravenchart.Can.Fault_Plans;
