--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Simulated I/O boards: each has two joints of the arm.

with Surgical_Robot.Arm;

package body Surgical_Robot.Io_Board_Registers
with SPARK_Mode => Off
is
   use type Arm.Joint;
   use type Interfaces.Unsigned_32;

   type Words is array (Io_Board_Units.Unit) of Interfaces.Unsigned_32;
   type First_Joints is array (Io_Board_Units.Unit) of Arm.Joint;

   First : constant First_Joints :=
     (Io_Board_Units.Left_Unit => 1, Io_Board_Units.Right_Unit => 3);

   Control : Words := (others => 0)
   with Volatile;

   procedure Drive
     (Unit  : Io_Board_Units.Unit;
      Axis  : Arm.Joint;
      Value : Interfaces.Unsigned_32);
   --  An amplifier that is enabled drives its joint.

   procedure Drive
     (Unit  : Io_Board_Units.Unit;
      Axis  : Arm.Joint;
      Value : Interfaces.Unsigned_32) is
   begin
      if (Control (Unit) and 1) /= 0 then
         Arm.Drive (First (Unit) + Axis - 1, Integer (Value) - 2_048);
      end if;
   end Drive;

   function Count
     (Unit : Io_Board_Units.Unit; Axis : Arm.Joint)
      return Interfaces.Unsigned_32;
   --  What an encoder has counted, rounded down, in two's complement.

   function Count
     (Unit : Io_Board_Units.Unit; Axis : Arm.Joint)
      return Interfaces.Unsigned_32
   is
      Turned  : constant Integer :=
        Arm.Place (First (Unit) + Axis - 1)
        * Integer (Io_Board_Units.Counts_Per_Mrad (Unit));
      Counted : constant Integer := (Turned - Turned mod 1_000) / 1_000;
   begin
      return Interfaces.Unsigned_32'Mod (Counted);
   end Count;

   procedure Read_Control
     (Unit : Io_Board_Units.Unit; Value : out Interfaces.Unsigned_32) is
   begin
      Value := Control (Unit);
   end Read_Control;

   procedure Write_Control
     (Unit : Io_Board_Units.Unit; Value : Interfaces.Unsigned_32) is
   begin
      Control (Unit) := Value;
   end Write_Control;

   procedure Read_Status
     (Unit : Io_Board_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := 1;
   end Read_Status;

   procedure Read_Count_1
     (Unit : Io_Board_Units.Unit; Value : out Interfaces.Unsigned_32) is
   begin
      Value := Count (Unit, 1);
   end Read_Count_1;

   procedure Read_Count_2
     (Unit : Io_Board_Units.Unit; Value : out Interfaces.Unsigned_32) is
   begin
      Value := Count (Unit, 2);
   end Read_Count_2;

   procedure Write_Dac_1
     (Unit : Io_Board_Units.Unit; Value : Interfaces.Unsigned_32) is
   begin
      Drive (Unit, 1, Value);
   end Write_Dac_1;

   procedure Write_Dac_2
     (Unit : Io_Board_Units.Unit; Value : Interfaces.Unsigned_32) is
   begin
      Drive (Unit, 2, Value);
   end Write_Dac_2;
end Surgical_Robot.Io_Board_Registers;
