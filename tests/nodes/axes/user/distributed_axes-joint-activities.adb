--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Distributed_Axes.Joint.Activities
with SPARK_Mode
is
   procedure Serve
     (Motion_Request : Joint.Motion_Requests.Request;
      Home_Reply     : out Outcome;
      Goal           : in out Place) is
   begin
      Home_Reply := Unknown;

      case Motion_Request.Name is
         when Motion_Requests.Home_Asked =>
            Goal := 0;
            Home_Reply := Well;

         when Motion_Requests.Move_Asked =>
            Goal := Motion_Request.Move;
      end case;
   end Serve;
end Distributed_Axes.Joint.Activities;
