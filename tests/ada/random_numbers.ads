--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Random numbers that are the same in each run: a linear congruential
--  generator of 64 bits.

with Interfaces;

package Random_Numbers is
   use type Interfaces.Unsigned_64;

   function Random return Interfaces.Unsigned_64;
   --  The next number.

   function Random (First, Last : Natural) return Natural
   is (First
       + Natural (Random mod Interfaces.Unsigned_64 (Last - First + 1)));
   --  A number from First to Last.

end Random_Numbers;
