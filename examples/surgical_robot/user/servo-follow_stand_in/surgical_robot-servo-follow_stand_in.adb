--  Position from velocity, where there is no encoder.

package body Surgical_Robot.Servo.Follow_Stand_In
with SPARK_Mode
is
   use type Ravenchart.Number;

   Per_Second : constant := 200;  --  executions
   Farthest   : constant := 3_000;  --  mrad

   function Next (From : Angle; By : Speed) return Angle
   with Global => null;
   --  Where a joint is after one more execution.

   function Next (From : Angle; By : Speed) return Angle is
      To : constant Ravenchart.Number :=
        Ravenchart.Number (From) + Ravenchart.Number (By) / Per_Second;
   begin
      return
        Angle
          (Ravenchart.Number'Max
             (-Farthest, Ravenchart.Number'Min (Farthest, To)));
   end Next;

   procedure Follow (Get_Velocity : Speed_X4; Followed : in out Angle_X4) is
   begin
      Followed :=
        (Axis_1 => Next (Followed.Axis_1, Get_Velocity.Axis_1),
         Axis_2 => Next (Followed.Axis_2, Get_Velocity.Axis_2),
         Axis_3 => Next (Followed.Axis_3, Get_Velocity.Axis_3),
         Axis_4 => Next (Followed.Axis_4, Get_Velocity.Axis_4));
   end Follow;
end Surgical_Robot.Servo.Follow_Stand_In;
