--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A simulated tachometer: what the arm moved in the last 5 ms, in mrad/s.

with Surgical_Robot.Arm;

package body Surgical_Robot.Tachometer_Registers
with SPARK_Mode => Off
is
   procedure Read_Speed_1
     (Unit : Tachometer_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := Interfaces.Unsigned_32'Mod (Arm.Moved (1) / 5);
   end Read_Speed_1;

   procedure Read_Speed_2
     (Unit : Tachometer_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := Interfaces.Unsigned_32'Mod (Arm.Moved (2) / 5);
   end Read_Speed_2;

   procedure Read_Speed_3
     (Unit : Tachometer_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := Interfaces.Unsigned_32'Mod (Arm.Moved (3) / 5);
   end Read_Speed_3;

   procedure Read_Speed_4
     (Unit : Tachometer_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := Interfaces.Unsigned_32'Mod (Arm.Moved (4) / 5);
   end Read_Speed_4;
end Surgical_Robot.Tachometer_Registers;
