--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Ctu_Registers
  with SPARK_Mode
is

   -------------------
   -- Choose_Timing --
   -------------------

   procedure Choose_Timing
     (Clock, Rate : Hertz;
      Most        : Quanta_Count;
      T           : out Bit_Timing;
      Found       : out Boolean)
   is
      Prescaler : Hertz;
      Count     : Hertz;
   begin
      Bit_Timings.Choose_Quanta
        (Clock, Rate,
         Last_Prescaler => 255,
         Least          => Quanta_Count'First,
         Most           => Most,
         Prescaler      => Prescaler,
         Quanta         => Count,
         Found          => Found);
      T :=
        (if Found
         then (Prescaler   => Prescaler,
               Propagation => Count - 1 - 2 * (Count / 5),
               Phase_1     => Count / 5,
               Phase_2     => Count / 5)
         else (others => <>));
   end Choose_Timing;

end Ravenchart.Can.Ctu_Registers;
