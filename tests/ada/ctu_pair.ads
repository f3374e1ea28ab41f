--  Two cores of a card with CTU CAN FD, on one bus: the one that the
--  environment names, and the one behind it.

with Ravenchart.Can.Ctu_Cores;

package Ctu_Pair is

   package Near is new Ravenchart.Can.Ctu_Cores (Behind => 0);

   package Far is new Ravenchart.Can.Ctu_Cores (Behind => 1);

end Ctu_Pair;
