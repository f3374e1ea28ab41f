--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Shared_Slots
  with SPARK_Mode => Off
is
   Slots : array (Place_Number) of Element_Type := (others => Initial)
   with Volatile_Components;
   --  Volatile: no access moves across that of an atomic object (RM C.6(16)).

   procedure Write (Place : Place_Number; Item : Element_Type) is
   begin
      Slots (Place) := Item;
   end Write;

   procedure Read (Place : Place_Number; Item : out Element_Type) is
   begin
      Item := Slots (Place);
   end Read;

end Ravenchart.Shared_Slots;
