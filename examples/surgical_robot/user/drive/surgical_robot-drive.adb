--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  An intelligent drive of four axes: goals and positions in mrad.

with Surgical_Robot.Words;

package body Surgical_Robot.Drive
with SPARK_Mode
is
   Hold_There : constant Words.Word := 0;
   Go         : constant Words.Word := 1;
   Farthest   : constant := 3_000;

   function Place (Value : Words.Word) return Angle
   is (Angle (Words.Clamped (Words.Signed (Value), Farthest)))
   with Global => null;

   function Goal (Value : Angle) return Words.Word
   is (Words.Raw (Ravenchart.Number (Value)))
   with Global => null;

   procedure Make_Safe
     (Unit : Drive_Units.Unit; Device : in out Drive_States.State)
   is
      pragma Unreferenced (Device);
   begin
      Drive_Registers.Write_Mode (Unit, Hold_There);
   end Make_Safe;

   procedure Get_Position
     (Unit   : Drive_Units.Unit;
      Device : in out Drive_States.State;
      Reply  : out Angle_X4)
   is
      pragma Unreferenced (Device);
      Word_1, Word_2, Word_3, Word_4 : Words.Word;
   begin
      Drive_Registers.Read_Position_1 (Unit, Word_1);
      Drive_Registers.Read_Position_2 (Unit, Word_2);
      Drive_Registers.Read_Position_3 (Unit, Word_3);
      Drive_Registers.Read_Position_4 (Unit, Word_4);
      Reply :=
        (Axis_1 => Place (Word_1),
         Axis_2 => Place (Word_2),
         Axis_3 => Place (Word_3),
         Axis_4 => Place (Word_4));
   end Get_Position;

   procedure Set_Goal
     (Unit     : Drive_Units.Unit;
      Device   : in out Drive_States.State;
      Argument : Angle_X4)
   is
      pragma Unreferenced (Device);
   begin
      Drive_Registers.Write_Goal_1 (Unit, Goal (Argument.Axis_1));
      Drive_Registers.Write_Goal_2 (Unit, Goal (Argument.Axis_2));
      Drive_Registers.Write_Goal_3 (Unit, Goal (Argument.Axis_3));
      Drive_Registers.Write_Goal_4 (Unit, Goal (Argument.Axis_4));
      Drive_Registers.Write_Mode (Unit, Go);
   end Set_Goal;

   procedure Hold
     (Unit : Drive_Units.Unit; Device : in out Drive_States.State)
   is
      pragma Unreferenced (Device);
   begin
      Drive_Registers.Write_Mode (Unit, Hold_There);
   end Hold;
end Surgical_Robot.Drive;
