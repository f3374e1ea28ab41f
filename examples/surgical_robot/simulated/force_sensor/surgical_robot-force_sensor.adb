--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A simulated device of the model of Surgical_Robot, written once by
--  ravenchart as a starting point. The file is yours to change.

package body Surgical_Robot.Force_Sensor
with SPARK_Mode
is
   use type Force_Sensor_States.Call_Count;

   procedure Self_Test
     (Device : in out Force_Sensor_States.State; Passed : out Boolean) is
   begin
      Device.Calls := Device.Calls + 1;
      Passed := True;
   end Self_Test;

   procedure Get_Force
     (Device : in out Force_Sensor_States.State;
      Reply  : out Surgical_Robot.Force) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Get_Force_Reply;
   end Get_Force;
end Surgical_Robot.Force_Sensor;
