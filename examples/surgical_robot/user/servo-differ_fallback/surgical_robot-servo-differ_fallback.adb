--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Velocity from position, where there is no tachometer.

package body Surgical_Robot.Servo.Differ_Fallback
with SPARK_Mode
is
   use type Ravenchart.Number;

   Per_Second : constant := 200;  --  executions
   Fastest    : constant := 4_000;  --  mrad/s

   function Rate (Now, Past : Angle) return Speed
   with
     Global => null,
     Post   =>
       (if abs (Ravenchart.Number (Now) - Ravenchart.Number (Past))
          <= Fastest / Per_Second
        then Ravenchart.Number (Rate'Result)
          = (Ravenchart.Number (Now) - Ravenchart.Number (Past))
            * Per_Second);
   --  The speed of a joint that moved from Past to Now in one execution.

   subtype Microradians is Ravenchart.Number range -3_000_000 .. 3_000_000;

   function Seen (Place : Microradians) return Angle
   is (Angle ((Place - Place mod 1_000) / 1_000))
   with Ghost, Global => null;
   --  The position that an encoder reads: whole mrad, rounded down.

   procedure Lemma_Resolution (Now, Past : Microradians)
   with
     Ghost,
     Global => null,
     Pre    => abs (Now - Past) <= (Fastest / Per_Second - 1) * 1_000,
     Post   =>
       abs (Ravenchart.Number (Rate (Seen (Now), Seen (Past))) * 5
            - (Now - Past)) < 1_000;
   --  In an execution of 5 ms a joint moves by 5 microradians for each mrad/s.
   --  So the estimate differs from the mean velocity by less than 200 mrad/s:
   --  one mrad, the resolution of the encoder, in 5 ms.

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

   pragma Unreferenced (Lemma_Resolution);

   procedure Lemma_Resolution (Now, Past : Microradians) is null;

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
end Surgical_Robot.Servo.Differ_Fallback;
