--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Position from velocity, where there is no encoder.

package body Surgical_Robot.Servo.Follow_Fallback
with SPARK_Mode
is
   use type Ravenchart.Number;

   Per_Second : constant := 200;  --  executions
   Farthest   : constant := 3_000;  --  mrad

   procedure Go_On (Place : in out Angle; Rest : in out Speed; By : Speed)
   with Global => null;
   --  The position of a joint after one more execution, in whole mrad. Rest is
   --  the movement beyond that, in units of a mrad divided by Per_Second.

   procedure Go_On (Place : in out Angle; Rest : in out Speed; By : Speed) is
      Moved : constant Ravenchart.Number :=
        Ravenchart.Number (By) + Ravenchart.Number (Rest);
      To    : constant Ravenchart.Number :=
        Ravenchart.Number (Place) + Moved / Per_Second;
   begin
      Place :=
        Angle
          (Ravenchart.Number'Max
             (-Farthest, Ravenchart.Number'Min (Farthest, To)));
      Rest := Speed (Moved rem Per_Second);
   end Go_On;

   procedure Follow
     (Get_Velocity : Speed_X4;
      Followed     : in out Angle_X4;
      Rest         : in out Speed_X4) is
   begin
      Go_On (Followed.Axis_1, Rest.Axis_1, Get_Velocity.Axis_1);
      Go_On (Followed.Axis_2, Rest.Axis_2, Get_Velocity.Axis_2);
      Go_On (Followed.Axis_3, Rest.Axis_3, Get_Velocity.Axis_3);
      Go_On (Followed.Axis_4, Rest.Axis_4, Get_Velocity.Axis_4);
   end Follow;
end Surgical_Robot.Servo.Follow_Fallback;
