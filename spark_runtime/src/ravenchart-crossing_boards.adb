--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Shared_Slots;

package body Ravenchart.Crossing_Boards
  with
    SPARK_Mode,
    Refined_State => (State => (Latest, Reading, Newest, Slots.State))
is
   --  The steps have the names that proofs/interleavings/four_slot_steps.ads
   --  gives them.

   type Side is range 0 .. 1;

   type Sides is array (Side) of Side
   with Component_Size => 8, Size => 16;

   package Slots is new Shared_Slots
     (Element_Type => Element_Type,
      Initial      => Initial,
      Last         => 3);

   Latest : Side := 0
   with Atomic, Async_Readers, Async_Writers;
   --  The pair that was written last.

   Reading : Side := 0
   with Atomic, Async_Readers, Async_Writers;
   --  The pair that the reader reads, or has read.

   Newest : Sides := (others => 0)
   with Atomic, Async_Readers, Async_Writers;
   --  The half of each pair that was written last; accessed as a whole.

   function Place (Pair, Half : Side) return Slots.Place_Number
   is (2 * Natural (Pair) + Natural (Half))
   with Global => null;

   procedure Write (Item : Element_Type)
   with
     Refined_Global =>
       (Input  => Reading,
        Output => Latest,
        In_Out => (Newest, Slots.State))
   is
      Pair   : Side;
      Halves : Sides;
   begin
      Pair   := Reading;  --  Avoid
      Pair   := 1 - Pair;
      Halves := Newest;
      Halves (Pair) := 1 - Halves (Pair);
      Slots.Write (Place (Pair, Halves (Pair)), Item);  --  Fill
      Newest := Halves;  --  Show_Half
      Latest := Pair;  --  Show_Pair
   end Write;

   procedure Read (Item : out Element_Type)
   with
     Refined_Global =>
       (Input  => (Latest, Newest, Slots.State),
        Output => Reading)
   is
      Pair   : Side;
      Halves : Sides;
   begin
      Pair    := Latest;  --  Look
      Reading := Pair;  --  Announce
      Halves  := Newest;  --  Choose
      Slots.Read (Place (Pair, Halves (Pair)), Item);  --  End_Copy
   end Read;

end Ravenchart.Crossing_Boards;
