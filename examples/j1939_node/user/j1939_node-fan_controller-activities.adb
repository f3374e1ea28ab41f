--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The speed of the fan, written by hand: it grows with the temperature of the
--  coolant, and is full where the temperature is not known.

package body J1939_Node.Fan_Controller.Activities
  with SPARK_Mode
is
   use Ravenchart;
   use type Ravenchart.Freshness;

   Warm : constant Coolant_Temperature := 80;
   Hot  : constant Coolant_Temperature := 100;
   --  The fan begins above Warm and has its full speed from Hot on.

   Step : constant Fan_Speed := 10;
   --  The largest change of the speed in one execution.

   Rpm_Of_Speed : constant := 24;
   --  3,000 rpm at full speed, in 0.5 rpm.

   function Wanted (Temperature : Coolant_Temperature) return Fan_Speed
   is (if Temperature <= Warm
       then 0
       elsif Temperature >= Hot
       then Fan_Speed'Last
       else
         Fan_Speed
           (Number (Temperature - Warm)
            * Number (Fan_Speed'Last)
            / Number (Hot - Warm)));

   function Approached (Speed, Goal : Fan_Speed) return Fan_Speed
   is (Fan_Speed'Max (Speed - Step, Fan_Speed'Min (Goal, Speed + Step)))
   with
     Post =>
       abs (Approached'Result - Speed) <= Step
       and then abs (Approached'Result - Goal) <= abs (Speed - Goal);

   procedure Regulate
     (Engine  : Fan_Controller.Engine_View;
      Setting : in out J1939_Node.Fan_Setting)
   is
      Is_Known : constant Boolean := Engine.State = Fresh;
      Goal     : constant Fan_Speed :=
        (if Is_Known then Wanted (Engine.Value) else Fan_Speed'Last);
   begin
      Setting.Speed := Approached (Setting.Speed, Goal);
      Setting.Rpm :=
        Fan_Rpm (Number (Setting.Speed) * Rpm_Of_Speed);
      Setting.State :=
        (if not Is_Known
         then Default_Operation
         elsif Setting.Speed = 0
         then Fan_Off
         else Coolant_Too_Hot);
   end Regulate;
end J1939_Node.Fan_Controller.Activities;
