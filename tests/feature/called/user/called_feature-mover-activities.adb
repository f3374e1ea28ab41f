--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Called_Feature.Mover.Activities
with SPARK_Mode
is
   procedure Serve
     (Motion_Request  : Mover.Motion_Requests.Request;
      Home_Reply      : out Outcome;
      Get_Limit_Reply : out Place;
      Now             : Place;
      Goal            : in out Place) is
   begin
      Home_Reply := Unknown;
      Get_Limit_Reply := 0;

      case Motion_Request.Name is
         when Motion_Requests.Set_Goal_Asked =>
            Goal := Motion_Request.Set_Goal;

         when Motion_Requests.Hold_Asked =>
            Goal := Now;

         when Motion_Requests.Home_Asked =>
            Home_Reply := Well;

         when Motion_Requests.Get_Limit_Asked =>
            case Motion_Request.Get_Limit is
               when Low =>
                  Get_Limit_Reply := -1_000;

               when High =>
                  Get_Limit_Reply := 1_000;
            end case;
      end case;
   end Serve;
end Called_Feature.Mover.Activities;
