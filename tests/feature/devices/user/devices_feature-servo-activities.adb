--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Devices_Feature.Servo.Activities
with SPARK_Mode
is
   use type Ravenchart.Number;

   Limit : constant := 500;

   function Damped (Position : Angle; Velocity : Speed) return Current;
   --  Against position and velocity, within Limit.

   function Damped (Position : Angle; Velocity : Speed) return Current is
      Wanted : constant Ravenchart.Number :=
        -(2 * Ravenchart.Number (Position)) - Ravenchart.Number (Velocity);
   begin
      return
        Current
          (Ravenchart.Number'Max
             (-Limit, Ravenchart.Number'Min (Limit, Wanted)));
   end Damped;

   procedure Control
     (Get_Position     : Angle_X4;
      Get_Velocity     : Speed_X4;
      Set_Current      : out Current_X4;
      Call_Set_Current : out Boolean;
      Call_Ring        : out Boolean) is
   begin
      Set_Current :=
        (Axis_1 => Damped (Get_Position.Axis_1, Get_Velocity.Axis_1),
         Axis_2 => Damped (Get_Position.Axis_2, Get_Velocity.Axis_2),
         Axis_3 => Damped (Get_Position.Axis_3, Get_Velocity.Axis_3),
         Axis_4 => Damped (Get_Position.Axis_4, Get_Velocity.Axis_4));
      Call_Set_Current := True;
      Call_Ring := False;
   end Control;
end Devices_Feature.Servo.Activities;
