--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Histories
  with SPARK_Mode
is
   ---------
   -- Put --
   ---------

   procedure Put
     (H : in out History; Item : Element_Type; Visible : Nanoseconds)
   is
      Before : constant Stamped_List := H.Last;
   begin
      if H.Count = 0 or else H.Last (1).Visible /= Visible then
         if H.Count < Depth then
            H.Count := H.Count + 1;
         end if;
         for I in 2 .. H.Count loop
            H.Last (I) := Before (I - 1);
            pragma Loop_Invariant
              (for all K in 2 .. I => H.Last (K) = Before (K - 1));
         end loop;
      end if;
      H.Last (1) := (Item, Visible);
   end Put;

   ------------
   -- Newest --
   ------------

   function Newest (H : History; Now : Nanoseconds) return Place_Count is
   begin
      for I in 1 .. H.Count loop
         if H.Last (I).Visible <= Now then
            return I;
         end if;
         pragma Loop_Invariant
           (for all K in 1 .. I => H.Last (K).Visible > Now);
      end loop;
      return 0;
   end Newest;

end Ravenchart.Histories;
