--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Devices_Feature.Servo.Estimate_Fallback
with SPARK_Mode
is
   use type Ravenchart.Number;

   Per_Second : constant := 100;
   --  Executions in a second.

   function Rate (Now, Before : Angle) return Speed;
   --  How fast one became the other in an execution, within range.

   function Rate (Now, Before : Angle) return Speed is
      Moved : constant Ravenchart.Number :=
        Ravenchart.Number (Now) - Ravenchart.Number (Before);
      Wanted : constant Ravenchart.Number := Moved * Per_Second;
   begin
      return
        Speed
          (Ravenchart.Number'Max
             (-2_000, Ravenchart.Number'Min (2_000, Wanted)));
   end Rate;

   procedure Estimate
     (Get_Position : Angle_X4;
      Estimated    : out Speed_X4;
      Last         : in out Angle_X4) is
   begin
      Estimated :=
        (Axis_1 => Rate (Get_Position.Axis_1, Last.Axis_1),
         Axis_2 => Rate (Get_Position.Axis_2, Last.Axis_2),
         Axis_3 => Rate (Get_Position.Axis_3, Last.Axis_3),
         Axis_4 => Rate (Get_Position.Axis_4, Last.Axis_4));
      Last := Get_Position;
   end Estimate;
end Devices_Feature.Servo.Estimate_Fallback;
