--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Xcan_Registers
  with SPARK_Mode
is

   -------------------
   -- Choose_Timing --
   -------------------

   procedure Choose_Timing
     (Clock, Rate : Hertz; T : out Bit_Timing; Found : out Boolean)
   is
      Count : Hertz;
   begin
      T     := (others => <>);
      Found := False;
      for Prescaler in Hertz range 1 .. 256 loop
         Count := Clock / (Prescaler * Rate);
         if Count in Quanta_Count and then Prescaler * Rate * Count = Clock
         then
            T :=
              (Prescaler => Prescaler,
               Segment_1 => Count - 1 - Count / 5,
               Segment_2 => Count / 5);
            Found := True;
            return;
         end if;
      end loop;
   end Choose_Timing;

end Ravenchart.Can.Xcan_Registers;
