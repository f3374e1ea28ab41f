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
      for I in Index .. L.Used - 1 loop
         L.Events (I) := L.Events (I + 1);
         pragma Loop_Invariant
           (for all J in 1 .. L.Used =>
              L.Events (J) =
                L.Events'Loop_Entry
                  (if J in Index .. I then J + 1 else J));
      end loop;
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
