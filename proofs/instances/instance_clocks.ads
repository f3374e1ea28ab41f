--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Lengths of time in ticks of four clocks: of 1 ns and of 10 ns, and of two
--  whose ticks are no whole number of nanoseconds (STM32F4, Zynq-7000).

with Ravenchart.Clock_Ticks;

package Instance_Clocks
  with SPARK_Mode
is
   package Of_1_Ns is new Ravenchart.Clock_Ticks
     (Ticks_Per_Second => 1_000_000_000);

   package Of_10_Ns is new Ravenchart.Clock_Ticks
     (Ticks_Per_Second => 100_000_000);

   package Of_168_Mhz is new Ravenchart.Clock_Ticks
     (Ticks_Per_Second => 168_000_000);

   package Of_333_Mhz is new Ravenchart.Clock_Ticks
     (Ticks_Per_Second => 333_333_343);
end Instance_Clocks;
