--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A simulated tracker: it sees the arm.

with Surgical_Robot.Arm;

package body Surgical_Robot.Tracker_Registers
with SPARK_Mode => Off
is
   procedure Read_Position_1
     (Unit : Tracker_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := Interfaces.Unsigned_32'Mod (Arm.Place (1) / 1_000);
   end Read_Position_1;

   procedure Read_Position_2
     (Unit : Tracker_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := Interfaces.Unsigned_32'Mod (Arm.Place (2) / 1_000);
   end Read_Position_2;

   procedure Read_Position_3
     (Unit : Tracker_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := Interfaces.Unsigned_32'Mod (Arm.Place (3) / 1_000);
   end Read_Position_3;

   procedure Read_Position_4
     (Unit : Tracker_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := Interfaces.Unsigned_32'Mod (Arm.Place (4) / 1_000);
   end Read_Position_4;
end Surgical_Robot.Tracker_Registers;
