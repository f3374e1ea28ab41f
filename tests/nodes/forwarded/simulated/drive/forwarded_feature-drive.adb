--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A drive that is at its goal at once, and is reset well. It may go further
--  up than down.

package body Forwarded_Feature.Drive
with SPARK_Mode
is
   use type Drive_States.Call_Count;

   procedure Set_Goal
     (Device   : in out Drive_States.State;
      Argument : Forwarded_Feature.Place) is
   begin
      Device.Calls := Device.Calls + 1;
      Device.Place := Argument;
   end Set_Goal;

   procedure Release (Device : in out Drive_States.State) is
   begin
      Device.Calls := Device.Calls + 1;
   end Release;

   procedure Reset
     (Device : in out Drive_States.State;
      Reply  : out Forwarded_Feature.Outcome) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Forwarded_Feature.Well;
   end Reset;

   procedure Get_Limit
     (Device   : in out Drive_States.State;
      Argument : Forwarded_Feature.Side;
      Reply    : out Forwarded_Feature.Place) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply :=
        (case Argument is
            when Forwarded_Feature.Low  => -500,
            when Forwarded_Feature.High => 950);
   end Get_Limit;

   procedure Get_Place
     (Device : in out Drive_States.State;
      Reply  : out Forwarded_Feature.Place) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Place;
   end Get_Place;
end Forwarded_Feature.Drive;
