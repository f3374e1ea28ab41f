--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The control code of one joint, written by hand. A trapezoidal profile is
--  stepped every 5 ms; every 10 ms a proportional controller with the
--  profile's speed fed forward turns it into a set point for the drive.

package body Cartesian_Robot.Joint.Activities
  with SPARK_Mode
is
   use Ravenchart;
   use type Motion_States.Leaf;

   Steps_Per_Second : constant := 200;
   --  Trajectory_Step runs every 5 ms.

   Acceleration : constant := 800_000;
   --  The acceleration of the profile, in um/s2.

   Speed_Step : constant := Acceleration / Steps_Per_Second;
   --  The change of the profile's speed in one step, in um/s.

   Position_Gain : constant := 8;
   --  The gain of the controller, in 1/s.

   Seeking_Speed : constant := 40_000;
   Leaving_Speed : constant := 4_000;
   --  The speed towards the low end, and off its switch, in um/s.

   function Clamped (Value, Low, High : Number) return Number
   is (Number'Max (Low, Number'Min (High, Value)))
   with Pre => Low <= High, Post => Clamped'Result in Low .. High;
   --  Value, or the nearer end of the range.

   procedure Slow_Down (Profile : in out Cartesian_Robot.Profile);
   --  One step of the deceleration to a stop.

   procedure Approach
     (Target    : Cartesian_Robot.Position;
      Top_Speed : Cartesian_Robot.Top_Speed;
      Profile   : in out Cartesian_Robot.Profile);
   --  One step of the trapezoid towards Target.

   procedure Advance
     (Profile : in out Cartesian_Robot.Profile; Pace : Number)
   with Pre => Pace in Number (Speed'First) .. Number (Speed'Last);
   --  Take Pace as the profile's speed, and move on by one step at it.

   -------------
   -- Advance --
   -------------

   procedure Advance
     (Profile : in out Cartesian_Robot.Profile; Pace : Number)
   is
      Reached : constant Number :=
        Number (Profile.Position) + Pace / Steps_Per_Second;
   begin
      Profile.Speed := Speed (Pace);
      Profile.Position :=
        Position
          (Clamped (Reached,
                    Number (Position'First),
                    Number (Position'Last)));
   end Advance;

   ---------------
   -- Slow_Down --
   ---------------

   procedure Slow_Down (Profile : in out Cartesian_Robot.Profile) is
      Pace : constant Number := Number (Profile.Speed);
   begin
      if abs Pace <= Speed_Step then
         Profile.Speed := 0;
         Profile.Phase := At_Rest;
      else
         Advance
           (Profile,
            (if Pace > 0 then Pace - Speed_Step else Pace + Speed_Step));
         Profile.Phase := Slowing_Down;
      end if;
   end Slow_Down;

   --------------
   -- Approach --
   --------------

   procedure Approach
     (Target    : Cartesian_Robot.Position;
      Top_Speed : Cartesian_Robot.Top_Speed;
      Profile   : in out Cartesian_Robot.Profile)
   is
      Way  : constant Number := Number (Target) - Number (Profile.Position);
      Sign : constant Number := (if Way < 0 then -1 else 1);
      Pace : constant Number :=
        (if Sign > 0 then Number (Profile.Speed) else -Number (Profile.Speed));
      --  Speed towards the target; negative while moving away from it.

      Braking_Way : constant Number :=
        Pace * Pace / (2 * Acceleration) + abs Pace / Steps_Per_Second;
      Faster : constant Number :=
        Number'Min (Pace + Speed_Step, Number (Top_Speed));
      Slower : constant Number := Number'Max (Pace - Speed_Step, Speed_Step);
      Limit  : constant Number := Number (Speed'Last);
   begin
      if abs Way <= Speed_Step / Steps_Per_Second
        and then abs Pace <= 2 * Speed_Step
      then
         Profile := (Position => Target, Speed => 0, Phase => At_Rest);
      elsif Pace > 0 and then abs Way <= Braking_Way then
         Advance (Profile, Sign * Clamped (Slower, -Limit, Limit));
         Profile.Phase := Slowing_Down;
      else
         Advance (Profile, Sign * Clamped (Faster, -Limit, Limit));
         Profile.Phase :=
           (if Faster = Number (Top_Speed) then At_Speed else Speeding_Up);
      end if;
   end Approach;

   ---------------------
   -- Trajectory_Step --
   ---------------------

   procedure Trajectory_Step
     (Goal      : Cartesian_Robot.Goal;
      Measured  : Cartesian_Robot.Measurement;
      Top_Speed : Cartesian_Robot.Top_Speed;
      Profile   : in out Cartesian_Robot.Profile)
   is
   begin
      case Goal.Wanted is
         when Hold =>
            Slow_Down (Profile);

         when Seek_Low_End | Leave_Low_End =>
            Profile :=
              (Position => Measured.Position, Speed => 0, Phase => At_Rest);

         when Go =>
            Approach (Goal.Target, Top_Speed, Profile);
      end case;
   end Trajectory_Step;

   ----------------------
   -- Position_Control --
   ----------------------

   procedure Position_Control
     (Profile  : Cartesian_Robot.Profile;
      Feedback : Cartesian_Robot.Joint.Feedback_View;
      Homed    : Boolean;
      Motion   : Joint.Motion_States.Leaf;
      Origin   : in out Cartesian_Robot.Encoder_Count;
      Measured : out Cartesian_Robot.Measurement;
      Drive    : out Cartesian_Robot.Drive_Set_Point)
   is
      Count : constant Number := Number (Feedback.Value.Count);
      Pace  : Number;
   begin
      if Motion in Motion_States.Homing
        and then not (Motion = Motion_States.Backing_Off
                      and then Feedback.Value.Limit = Clear)
      then
         Origin := Feedback.Value.Count;
         --  The last position before the switch releases is the origin.
      end if;

      Measured.Position :=
        Position
          (Clamped (Count - Number (Origin),
                    Number (Position'First),
                    Number (Position'Last)));
      Measured.Speed := Feedback.Value.Speed;
      Measured.Error :=
        (if Homed and then Motion in Motion_States.Operational
         then Profile.Position - Measured.Position
         else 0);

      Pace :=
        (case Motion is
            when Motion_States.Seeking     => -Seeking_Speed,
            when Motion_States.Backing_Off => Leaving_Speed,
            when others                    =>
              (if Homed
               then Number (Profile.Speed)
                    + Position_Gain * Number (Measured.Error)
               else 0));

      if Motion in Motion_States.Fault or else Feedback.State /= Fresh then
         Drive := (Mode => Disabled, Speed => 0);
      else
         Drive :=
           (Mode  => Enabled,
            Speed =>
              Speed
                (Clamped (Pace,
                          Number (Speed'First),
                          Number (Speed'Last))));
      end if;
   end Position_Control;

end Cartesian_Robot.Joint.Activities;
