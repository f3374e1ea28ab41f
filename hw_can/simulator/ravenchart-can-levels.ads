--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What one bit time on the bus can carry.
--
--  Guarantees   the order of the levels is that of a wired AND: what the bus
--               carries is the first of the levels that are sent
--  Tasking      none: levels are values
--  Timing       constant
--
--  ISO 11898-1 (2015): the dominant level is the logical 0, the recessive
--  level the logical 1.

package Ravenchart.Can.Levels
  with SPARK_Mode, Pure
is

   type Level is (Dominant, Recessive);
   --  Position 0 and 1, as the bits count.

   function Inverse (L : Level) return Level
   is (if L = Dominant then Recessive else Dominant)
   with Global => null;
   --  The level that a stuff bit after L has.

   function To_Level (One : Boolean) return Level
   is (if One then Recessive else Dominant)
   with Global => null;
   --  How a bit that is 1, or not, goes over the bus.

end Ravenchart.Can.Levels;
