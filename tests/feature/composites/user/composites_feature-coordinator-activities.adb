--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Composites_Feature.Coordinator.Activities
with SPARK_Mode
is
   procedure Serve
     (Motion_Request : Coordinator.Motion_Requests.Request;
      Sent_Home      : out Boolean) is
   begin
      case Motion_Request.Name is
         when Motion_Requests.Go_Home_Asked =>
            Sent_Home := True;
      end case;
   end Serve;
end Composites_Feature.Coordinator.Activities;
