--  Velocity from position, where there is no tachometer.

package body Surgical_Robot.Servo.Differ_Stand_In
with SPARK_Mode
is
   use type Ravenchart.Number;

   Per_Second : constant := 200;  --  executions
   Fastest    : constant := 4_000;  --  mrad/s

   function Rate (Now, Past : Angle) return Speed
   with Global => null;
   --  How fast a joint came from Past to Now, within one execution.

   function Rate (Now, Past : Angle) return Speed is
      Moved : constant Ravenchart.Number :=
        Ravenchart.Number (Now) - Ravenchart.Number (Past);
   begin
      return
        Speed
          (Ravenchart.Number'Max
             (-Fastest,
              Ravenchart.Number'Min (Fastest, Moved * Per_Second)));
   end Rate;

   procedure Differ
     (Get_Position : Angle_X4;
      Differed     : out Speed_X4;
      Before       : in out Angle_X4) is
   begin
      Differed :=
        (Axis_1 => Rate (Get_Position.Axis_1, Before.Axis_1),
         Axis_2 => Rate (Get_Position.Axis_2, Before.Axis_2),
         Axis_3 => Rate (Get_Position.Axis_3, Before.Axis_3),
         Axis_4 => Rate (Get_Position.Axis_4, Before.Axis_4));
      Before := Get_Position;
   end Differ;
end Surgical_Robot.Servo.Differ_Stand_In;
