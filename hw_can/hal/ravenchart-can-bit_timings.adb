--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Bit_Timings
  with SPARK_Mode
is

   -------------------
   -- Choose_Quanta --
   -------------------

   procedure Choose_Quanta
     (Clock, Rate    : Hertz;
      Last_Prescaler : Hertz;
      Least, Most    : Hertz;
      Prescaler      : out Hertz;
      Quanta         : out Hertz;
      Found          : out Boolean)
   is
      Count : Hertz;
   begin
      for Divisor in 1 .. Last_Prescaler loop
         Count := Clock / (Divisor * Rate);
         if Count in Least .. Most and then Divisor * Rate * Count = Clock
         then
            Prescaler := Divisor;
            Quanta    := Count;
            Found     := True;
            return;
         end if;
      end loop;
      Prescaler := 1;
      Quanta    := Least;
      Found     := False;
   end Choose_Quanta;

end Ravenchart.Can.Bit_Timings;
