--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The user's activity of the feature: it reads ports of three rows.

package body Grouped_Feature.Joint_Type.Activities
with SPARK_Mode
is
   use type Ravenchart.Number;

   procedure Control
     (Torque   : Joint_Type.Torque_View;
      Speed    : Joint_Type.Speed_View;
      Limit    : Joint_Type.Limit_View;
      Turned   : out Grouped_Feature.Speed;
      Position : out Grouped_Feature.Speed) is
   begin
      if Torque.Value < 0 then
         Turned := 0;
      else
         Turned := Speed.Value;
      end if;
      Position := Grouped_Feature.Speed'Max (Turned, Limit.Value);
   end Control;
end Grouped_Feature.Joint_Type.Activities;
