--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What a test program does on the bus: each frame whose identifier leaves
--  the rest Number when divided by 4 is sent back with its identifier plus
--  one, so that programs of other numbers can take it further. The standard
--  frame 16#7F0# + Number orders a burst of as many frames 16#102# as its
--  first two bytes say, whose data count them from 1.

package Echoes is

   pragma Elaborate_Body;

   Number : Natural range 0 .. 3 := 0
   with Atomic;

end Echoes;
