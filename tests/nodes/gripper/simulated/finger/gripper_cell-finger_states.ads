--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A simulated device of the model of Gripper_Cell, written once by
--  ravenchart as a starting point. The file is yours to change.

package Gripper_Cell.Finger_States
with SPARK_Mode
is
   type Call_Count is mod 2 ** 32;

   --  The arguments of the last calls, and the replies of the next ones.
   type State is record
      Calls           : Call_Count := 0;
      Get_Width_Reply : Gripper_Cell.Width_X2 :=
        Gripper_Cell.Default_Width_X2;
      Set_Force       : Gripper_Cell.Force_X2 :=
        Gripper_Cell.Default_Force_X2;
   end record;
end Gripper_Cell.Finger_States;
