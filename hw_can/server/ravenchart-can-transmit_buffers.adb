package body Ravenchart.Can.Transmit_Buffers
  with SPARK_Mode
is

   -------------------
   -- Head_Is_First --
   -------------------

   procedure Head_Is_First (B : Buffer) is
   begin
      for I in 1 .. B.Count loop
         pragma Loop_Invariant
           (for all J in 1 .. I => Rank_At (B, 1) <= Rank_At (B, J));
      end loop;
   end Head_Is_First;

   ---------------
   -- Place_For --
   ---------------

   function Place_For
     (B : Buffer; Frame : Bus_Frames.Bus_Frame) return Slot_Index
   is
      Rank   : constant Arbitration.Rank :=
        Arbitration.Rank_Of (Bus_Frames.Contender_Of (Frame));
      Result : Slot_Index := B.Count + 1;
   begin
      if B.Order = By_Priority then
         while Result > 1 and then Rank_At (B, Result - 1) > Rank loop
            Result := Result - 1;
            pragma Loop_Variant (Decreases => Result);
            pragma Loop_Invariant (Result <= B.Count);
            pragma Loop_Invariant
              (for all I in Result .. B.Count => Rank_At (B, I) > Rank);
         end loop;
      end if;
      return Result;
   end Place_For;

   ---------
   -- Put --
   ---------

   procedure Put (B : in out Buffer; Item : Request) is
      Place : constant Slot_Index := Place_For (B, Item.Frame);
      Start : constant Buffer := B
      with Ghost;
   begin
      B.Slots (Place + 1 .. B.Count + 1) := B.Slots (Place .. B.Count);
      B.Slots (Place) := Item;
      B.Count := B.Count + 1;
      pragma Assert
        (for all I in 1 .. Place - 1 => Rank_At (B, I) = Rank_At (Start, I));
      pragma Assert
        (for all I in Place + 1 .. B.Count =>
           Rank_At (B, I) = Rank_At (Start, I - 1));
   end Put;

   ---------------
   -- Drop_Head --
   ---------------

   procedure Drop_Head (B : in out Buffer) is
      Start : constant Buffer := B
      with Ghost;
   begin
      B.Slots (1 .. B.Count - 1) := B.Slots (2 .. B.Count);
      B.Count := B.Count - 1;
      pragma Assert
        (for all I in 1 .. B.Count =>
           Rank_At (B, I) = Rank_At (Start, I + 1));
   end Drop_Head;

   -----------
   -- Clear --
   -----------

   procedure Clear (B : in out Buffer) is
   begin
      B.Count := 0;
   end Clear;

end Ravenchart.Can.Transmit_Buffers;
