--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Times of small operations over several rounds, in nanoseconds.

package Measuring is

   generic
      with procedure Operation (Value : Integer);
   procedure Measure (Name : String);
   --  Put the median time of one Operation.

   generic
      with procedure Generated (Value : Integer);
      with procedure Hand_Written (Value : Integer);
   procedure Compare (Name : String);
   --  Put the shortest time of each; the rounds take turns.

end Measuring;
