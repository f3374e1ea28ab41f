--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The user's activities of the feature: each keeps its contract.

package body Contracts_Feature.Plant.Activities
with SPARK_Mode
is
   procedure Filter
     (Sensed : Plant.Sensed_View;
      Most   : Contracts_Feature.Level;
      Tank   : in out Contracts_Feature.Tank;
      Noted  : out Boolean)
   is
      Before : constant Contracts_Feature.Mode := Tank.Mode;
   begin
      if Sensed.State = Ravenchart.Fresh then
         Tank.Level := Contracts_Feature.Unit_L'Min (90, Sensed.Value);
      end if;
      Tank.Mode :=
        (if Tank.Level >= Most
         then Contracts_Feature.Draining
         else Contracts_Feature.Filling);
      Noted := Tank.Mode /= Before;
   end Filter;

   procedure Regulate
     (Tank          : Contracts_Feature.Tank;
      Low           : Contracts_Feature.Level;
      High          : Contracts_Feature.Level;
      Opening       : out Contracts_Feature.Level;
      Set_Lamp      : out Contracts_Feature.Mode;
      Call_Set_Lamp : out Boolean;
      Call_Beep     : out Boolean)
   is
      --  without `requires` this might not be in the range of the type
      Room : constant Contracts_Feature.Level := 95 - Tank.Level;
   begin
      if Tank.Level > High then
         Opening := 0;
      else
         Opening := Contracts_Feature.Unit_L'Max (Room, Low);
      end if;
      Set_Lamp := Tank.Mode;
      Call_Set_Lamp := Tank.Mode /= Contracts_Feature.Idle;
      Call_Beep := False;
   end Regulate;

   procedure Boost
     (Drive : Plant.Drive_States.Leaf;
      Rate  : Contracts_Feature.Level;
      Share : out Contracts_Feature.Level)
   is
      pragma Unreferenced (Drive);
   begin
      Share := Rate + Rate;
   end Boost;
end Contracts_Feature.Plant.Activities;
