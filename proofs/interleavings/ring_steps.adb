--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ring_Steps
  with SPARK_Mode
is
   procedure Find_Room (R : in out Ring) is
   begin
      if Following (R, R.Tail) /= R.Head then
         R.Producer := Room_Found;
      end if;
   end Find_Room;

   procedure Fill (R : in out Ring) is
   begin
      R.Slots (R.Tail) := R.Put;
      R.Producer       := Filling;
   end Fill;

   procedure Show (R : in out Ring) is
   begin
      R.Tail     := Following (R, R.Tail);
      R.Put      := R.Put + 1;
      R.Producer := Idle;
   end Show;

   procedure Find_Element (R : in out Ring) is
   begin
      if R.Head /= R.Tail then
         R.Consumer := Copying;
      end if;
   end Find_Element;

   procedure End_Copy (R : in out Ring; Got : out Number) is
   begin
      Got        := R.Slots (R.Head);
      R.Head     := Following (R, R.Head);
      R.Taken    := R.Taken + 1;
      R.Consumer := Idle;
   end End_Copy;

end Ring_Steps;
