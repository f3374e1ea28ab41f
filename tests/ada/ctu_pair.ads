--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Two cores of a card with CTU CAN FD, on one bus: the one that the
--  environment names, and the one behind it.

with Ravenchart.Can.Ctu_Cores;
with Ravenchart.Can.Ctu_Frames;

package Ctu_Pair is

   package Near is new Ravenchart.Can.Ctu_Cores (Behind => 0);

   package Far is new Ravenchart.Can.Ctu_Cores (Behind => 1);

   procedure Start_Near (Good : out Boolean);
   --  Good: it is a core with its buffers. Let it join the bus, for FD frames.

   procedure Start_Far (Good : out Boolean);
   --  The same for the other one.

   procedure Come
     (I : out Ravenchart.Can.Ctu_Frames.Image; Good : out Boolean);
   --  The next frame at the far core, after a wait of at most a second.

end Ctu_Pair;
