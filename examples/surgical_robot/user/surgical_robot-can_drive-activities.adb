--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The drive over CAN: its orders, as set points.

package body Surgical_Robot.Can_Drive.Activities
with SPARK_Mode
is
   procedure Take_Orders
     (Motion_Request : Can_Drive.Motion_Requests.Request;
      Seen           : Angle_X4;
      Goal           : out Angle_X4;
      Is_Ordered     : out Boolean) is
   begin
      case Motion_Request.Name is
         when Motion_Requests.Set_Goal_Asked =>
            Goal := Motion_Request.Set_Goal;

         when Motion_Requests.Hold_Asked =>
            Goal := Seen;
      end case;
      Is_Ordered := True;
   end Take_Orders;
end Surgical_Robot.Can_Drive.Activities;
