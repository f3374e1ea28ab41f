--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The time quanta of a bit, for a controller that divides its clock by a
--  prescaler.
--
--  Guarantees   no state
--  Tasking      none
--  Timing       at most Last_Prescaler steps

package Ravenchart.Can.Bit_Timings
  with SPARK_Mode, Pure
is
   type Hertz is range 0 .. 2**40;
   --  A clock, or a bit rate in bits per second.

   procedure Choose_Quanta
     (Clock, Rate    : Hertz;
      Last_Prescaler : Hertz;
      Least, Most    : Hertz;
      Prescaler      : out Hertz;
      Quanta         : out Hertz;
      Found          : out Boolean)
   with
     Global => null,
     Pre    =>
       Rate in 1 .. 2**30
       and then Last_Prescaler in 1 .. 256
       and then Least in 1 .. 255
       and then Most in Least .. 255,
     Post   =>
       Prescaler in 1 .. Last_Prescaler
       and then Quanta in Least .. Most
       and then (if Found then Prescaler * Rate * Quanta = Clock);
   --  The least prescaler, and with it the most quanta, that give exactly
   --  Rate. Found is False where Clock is no suitable multiple of Rate.

end Ravenchart.Can.Bit_Timings;
