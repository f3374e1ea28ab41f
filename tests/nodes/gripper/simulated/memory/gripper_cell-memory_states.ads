--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A simulated device of the model of Gripper_Cell, written once by
--  ravenchart as a starting point. The file is yours to change.

package Gripper_Cell.Memory_States
with SPARK_Mode
is
   type Call_Count is mod 2 ** 32;

   --  The arguments of the last calls, and the replies of the next ones.
   type State is record
      Calls           : Call_Count := 0;
      Get_Limit       : Gripper_Cell.Side := Gripper_Cell.Low;
      Get_Limit_Reply : Gripper_Cell.Width := 0;
      Calibrate_Reply : Gripper_Cell.Outcome := Gripper_Cell.Unknown;
   end record;
end Gripper_Cell.Memory_States;
