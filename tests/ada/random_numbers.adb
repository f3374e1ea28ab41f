--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Random_Numbers is

   Seed : Interfaces.Unsigned_64 := 1;

   ------------
   -- Random --
   ------------

   function Random return Interfaces.Unsigned_64 is
   begin
      Seed := Seed * 6_364_136_223_846_793_005 + 1_442_695_040_888_963_407;
      return Interfaces.Rotate_Left (Seed, 31);
   end Random;

end Random_Numbers;
