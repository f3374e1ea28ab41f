--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The levels of one bit time on the bus.
--
--  Guarantees   the order of the levels is that of a wired AND: the bus
--               carries the first of the levels that are sent
--  Tasking      none: levels are values
--  Timing       constant
--
--  ISO 11898-1 (2015): the dominant level is the logical 0, the recessive
--  level the logical 1.

package Ravenchart.Can.Levels
  with SPARK_Mode, Pure
is

   type Level is (Dominant, Recessive);
   --  The positions 0 and 1 are the values of the bits.

   function Inverse (L : Level) return Level
   is (if L = Dominant then Recessive else Dominant)
   with Global => null;
   --  The level that a stuff bit after L has.

   function To_Level (One : Boolean) return Level
   is (if One then Recessive else Dominant)
   with Global => null;
   --  The level of a bit that is 1, or 0.

end Ravenchart.Can.Levels;
