--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Gripper_Cell.Grasp.Activities
with SPARK_Mode
is
   procedure Serve
     (Work_Request : Grasp.Work_Requests.Request;
      Grip_Reply   : out Gripper_Cell.Outcome;
      Wanted       : out Gripper_Cell.Force) is
   begin
      Wanted := Work_Request.Grip;
      Grip_Reply := Well;
   end Serve;
end Gripper_Cell.Grasp.Activities;
