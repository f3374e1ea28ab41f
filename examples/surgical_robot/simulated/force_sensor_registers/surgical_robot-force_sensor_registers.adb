--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A simulated converter: nobody pushes.

package body Surgical_Robot.Force_Sensor_Registers
with SPARK_Mode => Off
is
   use type Interfaces.Unsigned_32;

   Is_Started : Boolean := False
   with Volatile;

   procedure Write_Control
     (Unit : Force_Sensor_Units.Unit; Value : Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Is_Started := (Value and 1) /= 0;
   end Write_Control;

   procedure Read_Status
     (Unit : Force_Sensor_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := (if Is_Started then 1 else 0);
   end Read_Status;

   procedure Read_Sample
     (Unit : Force_Sensor_Units.Unit; Value : out Interfaces.Unsigned_16)
   is
      pragma Unreferenced (Unit);
   begin
      Value := 16#8000#;
   end Read_Sample;
end Surgical_Robot.Force_Sensor_Registers;
