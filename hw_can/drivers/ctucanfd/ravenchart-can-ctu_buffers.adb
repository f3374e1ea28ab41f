--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Ctu_Buffers
  with SPARK_Mode
is

   ---------------
   -- Place_For --
   ---------------

   function Place_For (L : Line; Rank : Arbitration.Rank) return Place is
      Result : Place := L.Waiting + 1;
   begin
      while Result > 1 and then L.Ranks (Result - 1) > Rank loop
         Result := Result - 1;
         pragma Loop_Variant (Decreases => Result);
         pragma Loop_Invariant (Result <= L.Waiting);
         pragma Loop_Invariant
           (for all P in Result .. L.Waiting => L.Ranks (P) > Rank);
      end loop;
      return Result;
   end Place_For;

   ---------
   -- Put --
   ---------

   procedure Put
     (L    : in out Line;
      Rank : Arbitration.Rank;
      Into : out Ctu_Registers.Buffer)
   is
      At_Place : constant Place := Place_For (L, Rank);
      Count    : constant Place := L.Waiting + 1;
      Buffers  : Buffer_List := L.Buffers;
      Ranks    : Rank_List := L.Ranks;
   begin
      Into := L.Buffers (Count);
      Buffers (At_Place + 1 .. Count) := L.Buffers (At_Place .. Count - 1);
      Ranks (At_Place + 1 .. Count)   := L.Ranks (At_Place .. Count - 1);
      Buffers (At_Place) := Into;
      Ranks (At_Place)   := Rank;
      L := (Waiting => Count, Buffers => Buffers, Ranks => Ranks);
   end Put;

   ------------
   -- Remove --
   ------------

   procedure Remove (L : in out Line; Gone : Place) is
      Buffers : Buffer_List := L.Buffers;
      Ranks   : Rank_List := L.Ranks;
   begin
      Buffers (Gone .. Room - 1) := L.Buffers (Gone + 1 .. Room);
      Ranks (Gone .. Room - 1)   := L.Ranks (Gone + 1 .. Room);
      Buffers (Room) := L.Buffers (Gone);
      L :=
        (Waiting => L.Waiting - 1, Buffers => Buffers, Ranks => Ranks);
   end Remove;

   ----------------
   -- Priorities --
   ----------------

   function Priorities (L : Line) return Ctu_Registers.Word is

      function Level (B : Ctu_Registers.Buffer) return Ctu_Registers.Level
      is (if L.Buffers (1) = B then 4
          elsif L.Buffers (2) = B then 3
          elsif L.Buffers (3) = B then 2
          else 1);

   begin
      return
        Ctu_Registers.Priorities
          (Of_1 => Level (1),
           Of_2 => Level (2),
           Of_3 => Level (3),
           Of_4 => Level (4));
   end Priorities;

end Ravenchart.Can.Ctu_Buffers;
