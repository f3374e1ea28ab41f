--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Deferrals
  with SPARK_Mode
is
   ---------
   -- Due --
   ---------

   function Due (S : Store; Active : Configuration) return Lists.Length is
   begin
      for I in 1 .. Lists.Count (S.Kept) loop
         if Is_Due (S, Active, I) then
            return I;
         end if;
         pragma Loop_Invariant
           (for all J in 1 .. I => not Is_Due (S, Active, J));
      end loop;
      return 0;
   end Due;

   --------------
   -- Take_Due --
   --------------

   procedure Take_Due
     (S      : in out Store;
      Active : Configuration;
      Item   : out Event;
      Taken  : out Boolean)
   is
      Index : constant Lists.Length := Due (S, Active);
   begin
      Item  := Null_Event;
      Taken := Index > 0;
      if Taken then
         Item := Lists.Element (S.Kept, Index);
         Lists.Remove (S.Kept, Index);
         for N in Event_Name loop
            if Index <= S.Freed (N) then
               S.Freed (N) := S.Freed (N) - 1;
            end if;
            pragma Loop_Invariant
              (for all M in Event_Name =>
                 S.Freed (M) =
                   (if M <= N and then Index <= S.Freed'Loop_Entry (M)
                    then S.Freed'Loop_Entry (M) - 1
                    else S.Freed'Loop_Entry (M)));
         end loop;
      end if;
   end Take_Due;

   ------------
   -- Change --
   ------------

   procedure Change
     (S           : in out Store;
      Is_Deferral : Boolean;
      Item        : Event;
      D           : Domain;
      Active      : Configuration)
   is
      Count : constant Lists.Length := Lists.Count (S.Kept);
   begin
      for N in Event_Name loop
         if Is_Freed (N, D, Active) then
            S.Freed (N) := Count;
         end if;
         pragma Loop_Invariant
           (for all M in Event_Name =>
              S.Freed (M) =
                (if M <= N and then Is_Freed (M, D, Active)
                 then Count
                 else S.Freed'Loop_Entry (M)));
      end loop;
      if Is_Deferral then
         S.Lost := S.Lost or else Count = Capacity;
         Lists.Append (S.Kept, Item);
      end if;
   end Change;

end Ravenchart.Deferrals;
