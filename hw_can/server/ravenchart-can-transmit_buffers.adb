--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

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
     (B : Buffer; What : Request) return Slot_Index
   is
      Rank   : constant Arbitration.Rank := Rank_Of (What);
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

   procedure Put (B : in out Buffer; What : Request) is
      Place : constant Slot_Index := Place_For (B, What);
      Start : constant Buffer := B
      with Ghost;
   begin
      pragma Assert
        (if B.Order = By_Priority and then Place <= B.Count
         then Rank_Of (What) < Rank_At (B, Place));
      B.Slots (Place + 1 .. B.Count + 1) := B.Slots (Place .. B.Count);
      B.Slots (Place) := What;
      B.Count := B.Count + 1;
      pragma Assert
        (for all I in 1 .. Start.Count =>
           B.Slots (if I < Place then I else I + 1) = Start.Slots (I));
      pragma Assert (B.Slots (Place) = What);
      pragma Assert
        (for all I in 1 .. Place - 1 =>
           Rank_Of (B.Slots (I)) = Rank_Of (Start.Slots (I)));
      pragma Assert
        (for all I in Place + 1 .. B.Count =>
           Rank_Of (B.Slots (I)) = Rank_Of (Start.Slots (I - 1)));
      if B.Order = By_Priority then
         pragma Assert
           (for all I in 2 .. Place =>
              Rank_Of (B.Slots (I - 1)) <= Rank_Of (B.Slots (I)));
         pragma Assert
           (if Place < B.Count
            then Rank_Of (What) <= Rank_Of (B.Slots (Place + 1)));
         pragma Assert (Is_Ordered (Start.Slots, Start.Count));
         pragma Assert
           (for all I in Place + 2 .. B.Count =>
              Rank_Of (B.Slots (I - 1)) <= Rank_Of (B.Slots (I)));
      end if;
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
        (for all I in 1 .. B.Count => B.Slots (I) = Start.Slots (I + 1));
   end Drop_Head;

   -----------
   -- Clear --
   -----------

   procedure Clear (B : in out Buffer) is
   begin
      B.Count := 0;
   end Clear;

   -----------
   -- Reset --
   -----------

   procedure Reset (B : in out Buffer; Order : Discipline) is
   begin
      B.Count := 0;
      B.Order := Order;
   end Reset;

end Ravenchart.Can.Transmit_Buffers;
