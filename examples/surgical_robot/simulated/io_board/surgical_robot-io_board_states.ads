--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A simulated device of the model of Surgical_Robot, written once by
--  ravenchart as a starting point. The file is yours to change.

package Surgical_Robot.Io_Board_States
with SPARK_Mode
is
   type Call_Count is mod 2 ** 32;

   --  The arguments of the last calls, and the replies of the next ones.
   type State is record
      Calls              : Call_Count := 0;
      Get_Position_Reply : Surgical_Robot.Angle_X2 :=
        Surgical_Robot.Default_Angle_X2;
      Set_Current        : Surgical_Robot.Current_X2 :=
        Surgical_Robot.Default_Current_X2;
   end record;
end Surgical_Robot.Io_Board_States;
