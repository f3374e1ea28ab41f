--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A simulated device of the model of Surgical_Robot, written once by
--  ravenchart as a starting point. The file is yours to change.

package Surgical_Robot.Force_Sensor_States
with SPARK_Mode
is
   type Call_Count is mod 2 ** 32;

   --  The arguments of the last calls, and the replies of the next ones.
   type State is record
      Calls           : Call_Count := 0;
      Get_Force_Reply : Surgical_Robot.Force := 0;
   end record;
end Surgical_Robot.Force_Sensor_States;
