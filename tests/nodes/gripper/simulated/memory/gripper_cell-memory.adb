--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A simulated device of the model of Gripper_Cell, written once by
--  ravenchart as a starting point. The file is yours to change.

package body Gripper_Cell.Memory
with SPARK_Mode
is
   use type Memory_States.Call_Count;

   procedure Get_Limit
     (Device   : in out Memory_States.State;
      Argument : Gripper_Cell.Side;
      Reply    : out Gripper_Cell.Width) is
   begin
      Device.Calls := Device.Calls + 1;
      Device.Get_Limit := Argument;
      Reply := Device.Get_Limit_Reply;
   end Get_Limit;

   procedure Calibrate
     (Device : in out Memory_States.State;
      Reply  : out Gripper_Cell.Outcome) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Calibrate_Reply;
   end Calibrate;
end Gripper_Cell.Memory;
