--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The arm behind all simulated registers: what one device moves, another
--  measures. Nothing of it is part of a controller on hardware.

package Surgical_Robot.Arm
with SPARK_Mode => Off
is
   type Joint is range 1 .. 4;

   subtype Microradians is Integer range -3_000_000 .. 3_000_000;
   --  A joint has stops at both ends.

   procedure Drive (Item : Joint; Milliamperes : Integer);
   --  A current drives a joint for one execution of the servo loop.

   procedure Approach (Item : Joint; Goal : Microradians);
   --  A drive with its own servo loop goes on to a goal.

   function Place (Item : Joint) return Microradians;

   function Moved (Item : Joint) return Integer;
   --  How far the last Drive moved a joint, in microradians.
end Surgical_Robot.Arm;
