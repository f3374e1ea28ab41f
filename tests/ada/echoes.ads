--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The reaction of a test program to frames. It sends a frame back, with the
--  identifier plus one, if the remainder of the identifier by 4 is Number, so
--  that programs with other numbers can continue. The standard frame 16#7F0# +
--  Number orders a burst of frames 16#102#. Its first two bytes are their
--  number, and the data of these frames count them from 1.

package Echoes is

   pragma Elaborate_Body;

   Number : Natural range 0 .. 3 := 0
   with Atomic;

end Echoes;
