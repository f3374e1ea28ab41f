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
      Count : Hertz;
   begin
      T     := (others => <>);
      Found := False;
      for Prescaler in Hertz range 1 .. 255 loop
         Count := Clock / (Prescaler * Rate);
         if Count in Quanta_Count'First .. Most
           and then Prescaler * Rate * Count = Clock
         then
            T :=
              (Prescaler   => Prescaler,
               Propagation => Count - 1 - 2 * (Count / 5),
               Phase_1     => Count / 5,
               Phase_2     => Count / 5);
            Found := True;
            return;
         end if;
      end loop;
   end Choose_Timing;

end Ravenchart.Can.Ctu_Registers;
