--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A tracker: positions in mrad.

with Surgical_Robot.Words;

package body Surgical_Robot.Tracker
with SPARK_Mode
is
   Farthest : constant := 3_000;

   function Place (Value : Words.Word) return Angle
   is (Angle (Words.Clamped (Words.Signed (Value), Farthest)))
   with Global => null;

   procedure Get_Position
     (Unit   : Tracker_Units.Unit;
      Device : in out Tracker_States.State;
      Reply  : out Angle_X4)
   is
      pragma Unreferenced (Device);
      Word_1, Word_2, Word_3, Word_4 : Words.Word;
   begin
      Tracker_Registers.Read_Position_1 (Unit, Word_1);
      Tracker_Registers.Read_Position_2 (Unit, Word_2);
      Tracker_Registers.Read_Position_3 (Unit, Word_3);
      Tracker_Registers.Read_Position_4 (Unit, Word_4);
      Reply :=
        (Axis_1 => Place (Word_1),
         Axis_2 => Place (Word_2),
         Axis_3 => Place (Word_3),
         Axis_4 => Place (Word_4));
   end Get_Position;
end Surgical_Robot.Tracker;
