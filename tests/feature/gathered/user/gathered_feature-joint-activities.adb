--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Gathered_Feature.Joint.Activities
with SPARK_Mode
is
   procedure Serve
     (Motion_Request : Joint.Motion_Requests.Request;
      Home_Reply     : out Outcome;
      At_Home        : Place;
      Goal           : in out Place;
      Most           : in out Step) is
   begin
      Home_Reply := Unknown;

      case Motion_Request.Name is
         when Motion_Requests.Home_Asked  =>
            Goal := At_Home;
            Home_Reply := Well;

         when Motion_Requests.Move_Asked  =>
            Goal := Motion_Request.Move;

         when Motion_Requests.Limit_Asked =>
            Most := Motion_Request.Limit;
      end case;
   end Serve;
end Gathered_Feature.Joint.Activities;
