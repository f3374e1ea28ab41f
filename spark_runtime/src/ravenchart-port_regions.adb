--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Port_Regions
  with SPARK_Mode
is
   procedure Handle
     (P       : in out Port;
      Arrived : Boolean;
      Item    : Value_Type;
      Limit   : Execution_Count;
      Outcome : out Change) is
   begin
      Outcome := Nothing;
      if Arrived then
         P       := (Value => Item, State => Fresh, Age => 0);
         Outcome := Arrival;
      elsif P.State /= Never_Received then
         if P.Age < Execution_Count'Last then
            P.Age := P.Age + 1;
         end if;
         if P.Age > Limit then
            if P.State = Fresh then
               Outcome := Became_Stale;
            end if;
            P.State := Stale;
         end if;
      end if;
   end Handle;

end Ravenchart.Port_Regions;
