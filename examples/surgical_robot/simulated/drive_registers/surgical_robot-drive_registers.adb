--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Simulated drives: they go to their goals while somebody looks at them.

with Surgical_Robot.Arm;

package body Surgical_Robot.Drive_Registers
with SPARK_Mode => Off
is
   use type Interfaces.Unsigned_32;

   type Goals is array (Arm.Joint) of Arm.Microradians;

   Goal : Goals := (others => 0)
   with Volatile;

   Goes : Boolean := False
   with Volatile;

   function Signed (Value : Interfaces.Unsigned_32) return Integer
   is (if Value < 2**31
       then Integer (Value)
       else -Integer (not Value) - 1);

   function Looked_At (Item : Arm.Joint) return Interfaces.Unsigned_32;
   --  Where a joint is in mrad, a step nearer to its goal.

   function Looked_At (Item : Arm.Joint) return Interfaces.Unsigned_32 is
   begin
      if Goes then
         Arm.Approach (Item, Goal (Item));
      end if;
      return Interfaces.Unsigned_32'Mod (Arm.Place (Item) / 1_000);
   end Looked_At;

   procedure Write_Mode
     (Unit : Drive_Units.Unit; Value : Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Goes := Value = 1;
   end Write_Mode;

   procedure Write_Goal_1
     (Unit : Drive_Units.Unit; Value : Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Goal (1) := 1_000 * Signed (Value);
   end Write_Goal_1;

   procedure Write_Goal_2
     (Unit : Drive_Units.Unit; Value : Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Goal (2) := 1_000 * Signed (Value);
   end Write_Goal_2;

   procedure Write_Goal_3
     (Unit : Drive_Units.Unit; Value : Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Goal (3) := 1_000 * Signed (Value);
   end Write_Goal_3;

   procedure Write_Goal_4
     (Unit : Drive_Units.Unit; Value : Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Goal (4) := 1_000 * Signed (Value);
   end Write_Goal_4;

   procedure Read_Position_1
     (Unit : Drive_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := Looked_At (1);
   end Read_Position_1;

   procedure Read_Position_2
     (Unit : Drive_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := Looked_At (2);
   end Read_Position_2;

   procedure Read_Position_3
     (Unit : Drive_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := Looked_At (3);
   end Read_Position_3;

   procedure Read_Position_4
     (Unit : Drive_Units.Unit; Value : out Interfaces.Unsigned_32)
   is
      pragma Unreferenced (Unit);
   begin
      Value := Looked_At (4);
   end Read_Position_4;
end Surgical_Robot.Drive_Registers;
