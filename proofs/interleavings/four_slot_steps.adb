--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Four_Slot_Steps
  with SPARK_Mode
is
   procedure Avoid (B : in out Board) is
   begin
      B.Writer_Pair := 1 - B.Reading;
      B.Writer_Half := 1 - B.Newest (B.Writer_Pair);
      B.Writer      := Avoided;
   end Avoid;

   procedure Fill (B : in out Board) is
   begin
      B.Written := B.Written + 1;
      B.Slots (B.Writer_Pair, B.Writer_Half) := B.Written;
      B.Writer  := Filling;
   end Fill;

   procedure Show_Half (B : in out Board) is
   begin
      B.Newest (B.Writer_Pair) := B.Writer_Half;
      B.Writer := Half_Shown;
   end Show_Half;

   procedure Show_Pair (B : in out Board) is
   begin
      B.Latest := B.Writer_Pair;
      B.Shown  := B.Written;
      B.Writer := Idle;
   end Show_Pair;

   procedure Look (B : in out Board) is
   begin
      B.Reader_Pair := B.Latest;
      B.Asked       := B.Shown;
      B.Reader      := Looked;
   end Look;

   procedure Announce (B : in out Board) is
   begin
      B.Reading := B.Reader_Pair;
      B.Reader  := Announced;
   end Announce;

   procedure Choose (B : in out Board) is
   begin
      B.Reader_Half := B.Newest (B.Reader_Pair);
      B.Reader      := Copying;
   end Choose;

   procedure End_Copy (B : in out Board) is
   begin
      B.Got    := B.Slots (B.Reader_Pair, B.Reader_Half);
      B.Reader := Idle;
   end End_Copy;

end Four_Slot_Steps;
