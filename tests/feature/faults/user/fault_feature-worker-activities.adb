--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Fault_Feature.Worker.Activities
  with SPARK_Mode
is
   use type Ravenchart.Number;

   procedure Toil (Rounds : in out Fault_Feature.Count) is
      Value : Count := 0;
   begin
      if Rounds = 3 then
         --  far more than the budget, once
         for I in 1 .. 200_000_000 loop
            Value := (if Value = Count'Last then 0 else Value + 1);
         end loop;
      end if;
      Rounds := (if Rounds = Count'Last then Rounds else Rounds + 1);
      if Value > 999 then
         Rounds := 0;
      end if;
   end Toil;

end Fault_Feature.Worker.Activities;
