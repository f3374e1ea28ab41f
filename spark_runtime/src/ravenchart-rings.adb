--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Rings
  with SPARK_Mode
is
   function Length (R : Ring) return Length_Type
   is (R.Count);

   function Place (R : Ring; Nth : Capacity_Type) return Capacity_Type
   is (if Nth - 1 <= R.Capacity - R.First
       then R.First + (Nth - 1)
       else Nth - 1 - (R.Capacity - R.First));
   --  Wraps by a branch, since provers dislike "mod".

   ------------
   -- Extend --
   ------------

   procedure Extend (R : in out Ring; Newest : out Capacity_Type) is
   begin
      R.Count := R.Count + 1;
      Newest  := Place (R, R.Count);
   end Extend;

   ------------
   -- Shrink --
   ------------

   procedure Shrink (R : in out Ring; Oldest : out Capacity_Type) is
   begin
      Oldest  := R.First;
      R.First := (if R.First < R.Capacity then R.First + 1 else 1);
      R.Count := R.Count - 1;
   end Shrink;

end Ravenchart.Rings;
