--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A simulated device of the model of Gripper_Cell, written once by
--  ravenchart as a starting point. The file is yours to change.

package body Gripper_Cell.Finger
with SPARK_Mode
is
   use type Finger_States.Call_Count;

   procedure Get_Width
     (Device : in out Finger_States.State;
      Reply  : out Gripper_Cell.Width_X2) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Get_Width_Reply;
   end Get_Width;

   procedure Set_Force
     (Device   : in out Finger_States.State;
      Argument : Gripper_Cell.Force_X2) is
   begin
      Device.Calls := Device.Calls + 1;
      Device.Set_Force := Argument;
   end Set_Force;

   procedure Open_Up (Device : in out Finger_States.State) is
   begin
      Device.Calls := Device.Calls + 1;
   end Open_Up;
end Gripper_Cell.Finger;
