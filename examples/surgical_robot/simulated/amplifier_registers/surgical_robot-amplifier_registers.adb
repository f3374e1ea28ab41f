--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Simulated amplifiers: each drives two joints of the arm.

with Surgical_Robot.Arm;

package body Surgical_Robot.Amplifier_Registers
with SPARK_Mode => Off
is
   use type Arm.Joint;
   use type Interfaces.Unsigned_32;

   type Words is array (Amplifier_Units.Unit) of Interfaces.Unsigned_32;
   type First_Joints is array (Amplifier_Units.Unit) of Arm.Joint;

   First : constant First_Joints :=
     (Amplifier_Units.Left_Power_Unit  => 1,
      Amplifier_Units.Right_Power_Unit => 3);

   Control : Words := (others => 0)
   with Volatile;

   procedure Drive
     (Unit  : Amplifier_Units.Unit;
      Axis  : Arm.Joint;
      Value : Interfaces.Unsigned_32);
   --  An amplifier that is enabled drives its joint.

   procedure Drive
     (Unit  : Amplifier_Units.Unit;
      Axis  : Arm.Joint;
      Value : Interfaces.Unsigned_32) is
   begin
      if (Control (Unit) and 1) /= 0 then
         Arm.Drive (First (Unit) + Axis - 1, Integer (Value) - 2_048);
      end if;
   end Drive;

   procedure Read_Control
     (Unit : Amplifier_Units.Unit; Value : out Interfaces.Unsigned_32) is
   begin
      Value := Control (Unit);
   end Read_Control;

   procedure Write_Control
     (Unit : Amplifier_Units.Unit; Value : Interfaces.Unsigned_32) is
   begin
      Control (Unit) := Value;
   end Write_Control;

   procedure Write_Dac_1
     (Unit : Amplifier_Units.Unit; Value : Interfaces.Unsigned_32) is
   begin
      Drive (Unit, 1, Value);
   end Write_Dac_1;

   procedure Write_Dac_2
     (Unit : Amplifier_Units.Unit; Value : Interfaces.Unsigned_32) is
   begin
      Drive (Unit, 2, Value);
   end Write_Dac_2;
end Surgical_Robot.Amplifier_Registers;
