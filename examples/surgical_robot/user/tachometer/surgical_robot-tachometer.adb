--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A tachometer: speeds in mrad/s.

with Surgical_Robot.Words;

package body Surgical_Robot.Tachometer
with SPARK_Mode
is
   Fastest : constant := 4_000;

   function Rate (Value : Words.Word) return Speed
   is (Speed (Words.Clamped (Words.Signed (Value), Fastest)))
   with Global => null;

   procedure Get_Velocity
     (Unit   : Tachometer_Units.Unit;
      Device : in out Tachometer_States.State;
      Reply  : out Speed_X4)
   is
      pragma Unreferenced (Device);
      Word_1, Word_2, Word_3, Word_4 : Words.Word;
   begin
      Tachometer_Registers.Read_Speed_1 (Unit, Word_1);
      Tachometer_Registers.Read_Speed_2 (Unit, Word_2);
      Tachometer_Registers.Read_Speed_3 (Unit, Word_3);
      Tachometer_Registers.Read_Speed_4 (Unit, Word_4);
      Reply :=
        (Axis_1 => Rate (Word_1),
         Axis_2 => Rate (Word_2),
         Axis_3 => Rate (Word_3),
         Axis_4 => Rate (Word_4));
   end Get_Velocity;
end Surgical_Robot.Tachometer;
