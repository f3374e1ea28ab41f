--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The user's activity of the feature: it decides when to send.

package body May_Send_Feature.Gauge_Type.Activities
with SPARK_Mode
is
   procedure Measure
     (Limit       : May_Send_Feature.Level;
      Count       : in out May_Send_Feature.Level;
      Level       : out May_Send_Feature.Level;
      Alarm       : out May_Send_Feature.Alarm;
      Send_Alarm  : out Boolean;
      Report      : out May_Send_Feature.Level;
      Send_Report : out Boolean) is
   begin
      if Count < May_Send_Feature.Level'Last then
         Count := Count + 1;
      end if;
      Level := Count;
      Send_Alarm := Count = Limit or else Count = 2 * Limit;
      Alarm := (Level => Count, Urgent => Send_Alarm);
      Send_Report := Count <= Limit;
      Report := Count;
   end Measure;
end May_Send_Feature.Gauge_Type.Activities;
