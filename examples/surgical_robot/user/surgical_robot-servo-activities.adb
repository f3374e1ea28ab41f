--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The servo loop: orders, and one execution of four joints.

package body Surgical_Robot.Servo.Activities
with SPARK_Mode
is
   use type Ravenchart.Number;

   Gain      : constant := 4;  --  mA per mrad
   Damping   : constant := 4;  --  mrad/s per mA
   Stiffness : constant := 20;  --  mN per mrad
   Strongest : constant := 2_000;  --  mA

   function Wanted
     (Goal, Position : Angle; Velocity : Speed; Yield : Ravenchart.Number)
      return Current
   with Global => null, Pre => Yield in -250 .. 250;
   --  The current that drives a joint to a goal that yields by Yield, in mrad.

   procedure Take_Orders
     (Motion_Request : Servo.Motion_Requests.Request;
      Seen           : Angle_X4;
      Goal           : out Angle_X4) is
   begin
      case Motion_Request.Name is
         when Motion_Requests.Set_Goal_Asked =>
            Goal := Motion_Request.Set_Goal;

         when Motion_Requests.Hold_Asked =>
            Goal := Seen;
      end case;
   end Take_Orders;

   function Wanted
     (Goal, Position : Angle; Velocity : Speed; Yield : Ravenchart.Number)
      return Current
   is
      Off    : constant Ravenchart.Number :=
        Ravenchart.Number (Goal) + Yield - Ravenchart.Number (Position);
      Driven : constant Ravenchart.Number :=
        Gain * Off - Ravenchart.Number (Velocity) / Damping;
   begin
      return
        Current
          (Ravenchart.Number'Max
             (-Strongest, Ravenchart.Number'Min (Strongest, Driven)));
   end Wanted;

   procedure Control
     (Goal             : Angle_X4;
      Get_Position     : Angle_X4;
      Get_Velocity     : Speed_X4;
      Get_Force        : Force;
      Seen             : out Angle_X4;
      Set_Current      : out Current_X4;
      Call_Set_Current : out Boolean)
   is
      Yield : constant Ravenchart.Number :=
        Ravenchart.Number (Get_Force) / Stiffness;
   begin
      Set_Current :=
        (Axis_1 =>
           Wanted
             (Goal.Axis_1, Get_Position.Axis_1, Get_Velocity.Axis_1, Yield),
         Axis_2 =>
           Wanted
             (Goal.Axis_2, Get_Position.Axis_2, Get_Velocity.Axis_2, Yield),
         Axis_3 =>
           Wanted
             (Goal.Axis_3, Get_Position.Axis_3, Get_Velocity.Axis_3, Yield),
         Axis_4 =>
           Wanted
             (Goal.Axis_4, Get_Position.Axis_4, Get_Velocity.Axis_4, Yield));
      Call_Set_Current := True;
      Seen := Get_Position;
   end Control;
end Surgical_Robot.Servo.Activities;
