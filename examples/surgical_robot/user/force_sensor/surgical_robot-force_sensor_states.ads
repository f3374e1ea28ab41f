--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The last force that was converted.

package Surgical_Robot.Force_Sensor_States
with SPARK_Mode
is
   type State is record
      Last : Force := 0;
   end record;
end Surgical_Robot.Force_Sensor_States;
