--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Event_Lists
  with SPARK_Mode
is
   ------------
   -- Append --
   ------------

   procedure Append (L : in out List; Item : Event) is
   begin
      if L.Used < Capacity then
         L.Used            := L.Used + 1;
         L.Events (L.Used) := Item;
      end if;
   end Append;

   ------------
   -- Remove --
   ------------

   procedure Remove (L : in out List; Index : Positive) is
   begin
      L.Events (Index .. L.Used - 1) := L.Events (Index + 1 .. L.Used);
      L.Used := L.Used - 1;
   end Remove;

   -----------
   -- Clear --
   -----------

   procedure Clear (L : out List) is
   begin
      L := (Events => (others => Null_Event), Used => 0);
   end Clear;

end Ravenchart.Event_Lists;
