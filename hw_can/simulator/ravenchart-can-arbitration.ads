--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Arbitration: finds the frame that stays, of the frames that start together.
--
--  Guarantees   bit by bit on the bus, the frame that is first in the order of
--               the rules stays, and every other one finds the place at which
--               it lost. Without two frames that are alike, exactly one stays
--  Tasking      none: a contest is a value
--  Timing       linear in the contenders
--
--  ISO 11898-1 (2015), arbitration field and bus arbitration.

with Ravenchart.Can.Levels;

package Ravenchart.Can.Arbitration
  with SPARK_Mode, Pure
is
   use type Levels.Level;

   type Contender is record
      Id     : Identifier := 0;
      Format : Frame_Format := Can.Standard;
      Kind   : Frame_Kind := Data;
   end record
   with Predicate => Fits (Id, Format);
   --  The part of a frame in arbitration; a CAN FD frame is one with Data.

   function Base_Id (C : Contender) return Standard_Identifier
   is (if C.Format = Can.Standard then C.Id else C.Id / 2**18)
   with Global => null;
   --  The 11 bits that every format begins with.

   function Precedes (A, B : Contender) return Boolean
   is (Base_Id (A) < Base_Id (B)
       or else
         (Base_Id (A) = Base_Id (B)
          and then
            (if A.Format /= B.Format then A.Format = Can.Standard
             else A.Id < B.Id
                  or else (A.Id = B.Id
                           and then A.Kind = Data
                           and then B.Kind = Remote))))
   with Global => null;
   --  The rules: the lower base identifier, then standard before extended,
   --  then the lower identifier, then data before remote.

   type Rank is range 0 .. 2**32 - 1;
   --  The bits that are compared, read as a number.

   subtype Place is Positive range 1 .. 32;
   --  A bit of the comparison, the first on the bus is 1. The identifier
   --  extension bit (IDE) is in place 13 in both formats.

   function Compared (Format : Frame_Format) return Place
   is (if Format = Can.Standard then 13 else 32)
   with Global => null;
   --  The bits that a frame of this format has there.

   function Rank_Of (C : Contender) return Rank
   is (Rank (Base_Id (C)) * 2**21
       + (if C.Format = Can.Standard
          then (if C.Kind = Remote then 2**20 else 0)
          else 3 * 2**19
               + Rank (C.Id mod 2**18) * 2
               + (if C.Kind = Remote then 1 else 0)))
   with Global => null;
   --  Standard: identifier, RTR (RRS in CAN FD), IDE dominant. Extended: the
   --  same with SRR and IDE recessive, then 18 bits and RTR (RRS). A standard
   --  frame is filled up with dominant bits; no contest is decided there.

   procedure Rank_Is_Order (A, B : Contender)
   with
     Ghost,
     Global => null,
     Post   => (Rank_Of (A) < Rank_Of (B)) = Precedes (A, B)
               and then (Rank_Of (A) = Rank_Of (B)) = (A = B);
   --  The bits on the bus put frames in the order of the rules.

   subtype Prefix_Length is Natural range 0 .. 32;
   --  The number of places that have been compared.

   function Power (N : Prefix_Length) return Long_Long_Integer
   is (case N is
         when 0  => 2**0,  when 1  => 2**1,  when 2  => 2**2,
         when 3  => 2**3,  when 4  => 2**4,  when 5  => 2**5,
         when 6  => 2**6,  when 7  => 2**7,  when 8  => 2**8,
         when 9  => 2**9,  when 10 => 2**10, when 11 => 2**11,
         when 12 => 2**12, when 13 => 2**13, when 14 => 2**14,
         when 15 => 2**15, when 16 => 2**16, when 17 => 2**17,
         when 18 => 2**18, when 19 => 2**19, when 20 => 2**20,
         when 21 => 2**21, when 22 => 2**22, when 23 => 2**23,
         when 24 => 2**24, when 25 => 2**25, when 26 => 2**26,
         when 27 => 2**27, when 28 => 2**28, when 29 => 2**29,
         when 30 => 2**30, when 31 => 2**31, when 32 => 2**32)
   with
     Ghost,
     Global => null;
   --  The count of numbers with so many bits.

   function Prefix (R : Rank; Length : Prefix_Length) return Rank
   with
     Global             => null,
     Subprogram_Variant => (Increases => Length),
     Post               =>
       Long_Long_Integer (Prefix'Result) < Power (Length);
   --  The first places of R, read as a number.

   function Level_At (R : Rank; P : Place) return Levels.Level
   is (Levels.To_Level (Prefix (R, P) mod 2 = 1))
   with Global => null;
   --  The bit that the frame sends there.

   type Contender_Index is range 1 .. 256;
   --  Frames that start together.

   type Contender_List is array (Contender_Index range <>) of Contender;

   subtype Loss is Natural range 0 .. 32;
   --  The place at which a frame lost; 0 when it did not.

   type Loss_List is array (Contender_Index range <>) of Loss;

   type Bus_Levels is array (Place) of Levels.Level;
   --  The level that all nodes read back.

   procedure Arbitrate
     (Contenders : Contender_List;
      Winner     : out Contender_Index;
      Lost_In    : out Loss_List;
      Bus        : out Bus_Levels)
   with
     Global => null,
     Pre    =>
       Contenders'First <= Contenders'Last
       and then Lost_In'First = Contenders'First
       and then Lost_In'Last = Contenders'Last,
     Post   =>
       Winner in Contenders'Range
       and then Lost_In (Winner) = 0
       and then
         (for all P in Place =>
            Bus (P) = Level_At (Rank_Of (Contenders (Winner)), P))
       and then
         (for all I in Contenders'Range =>
            (if Lost_In (I) = 0
             then Contenders (I) = Contenders (Winner)
             else Precedes (Contenders (Winner), Contenders (I))
               and then Bus (Lost_In (I)) = Levels.Dominant
               and then
                 Level_At (Rank_Of (Contenders (I)), Lost_In (I))
                 = Levels.Recessive));
   --  Each frame sends its bits as long as it reads back the bit that it
   --  sends. The winner is first in order. Only frames that are alike in all
   --  these bits stay with it, which ISO 11898-1 leaves to the users to rule
   --  out. A loser sent a recessive bit where it read a dominant one.

private

   function Prefix (R : Rank; Length : Prefix_Length) return Rank
   is (if Length = 32 then R else Prefix (R, Length + 1) / 2);

end Ravenchart.Can.Arbitration;
