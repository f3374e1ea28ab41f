--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Arbitration
  with SPARK_Mode
is

   function Sends
     (Contenders : Contender_List;
      I          : Contender_Index;
      P          : Place) return Levels.Level
   is (Level_At (Rank_Of (Contenders (I)), P))
   with
     Global => null,
     Pre    => I in Contenders'Range;
   --  The bit of frame I at place P.

   procedure Read_Bus
     (Contenders : Contender_List;
      Lost_In    : Loss_List;
      P          : Place;
      Winner     : in out Contender_Index;
      Bus        : out Levels.Level)
   with
     Global => null,
     Pre    =>
       Lost_In'First = Contenders'First
       and then Lost_In'Last = Contenders'Last
       and then Winner in Contenders'Range
       and then Lost_In (Winner) = 0,
     Post   =>
       Winner in Contenders'Range
       and then Lost_In (Winner) = 0
       and then Sends (Contenders, Winner, P) = Bus
       and then
         (for all I in Contenders'Range =>
            (if Lost_In (I) = 0 and then Bus = Levels.Recessive
             then Sends (Contenders, I, P) = Levels.Recessive));
   --  The wired AND of the frames that have not lost, and one frame that sends
   --  it.

   procedure Drop_Losers
     (Contenders : Contender_List;
      P          : Place;
      Bus        : Levels.Level;
      Lost_In    : in out Loss_List)
   with
     Global => null,
     Pre    =>
       Lost_In'First = Contenders'First
       and then Lost_In'Last = Contenders'Last,
     Post   =>
       (for all I in Contenders'Range =>
          Lost_In (I) =
            (if Lost_In'Old (I) = 0
               and then Sends (Contenders, I, P) /= Bus
             then P else Lost_In'Old (I)));
   --  A frame that reads another level than it sends has lost.

   procedure Ranks_Are_Order (Contenders : Contender_List; First : Contender)
   with
     Ghost,
     Global => null,
     Post   =>
       (for all I in Contenders'Range =>
          (Rank_Of (First) < Rank_Of (Contenders (I)))
          = Precedes (First, Contenders (I))
          and then (Rank_Of (First) = Rank_Of (Contenders (I)))
            = (First = Contenders (I)));
   --  Rank_Is_Order, for one frame against all.

   -------------------
   -- Rank_Is_Order --
   -------------------

   procedure Rank_Is_Order (A, B : Contender) is
   begin
      pragma Assert (A.Id = A.Id / 2**18 * 2**18 + A.Id mod 2**18);
      pragma Assert (B.Id = B.Id / 2**18 * 2**18 + B.Id mod 2**18);
   end Rank_Is_Order;

   ---------------------
   -- Ranks_Are_Order --
   ---------------------

   procedure Ranks_Are_Order (Contenders : Contender_List; First : Contender)
   is
   begin
      for I in Contenders'Range loop
         Rank_Is_Order (First, Contenders (I));
         pragma Loop_Invariant
           (for all J in Contenders'First .. I =>
              (Rank_Of (First) < Rank_Of (Contenders (J)))
              = Precedes (First, Contenders (J))
              and then (Rank_Of (First) = Rank_Of (Contenders (J)))
                = (First = Contenders (J)));
      end loop;
   end Ranks_Are_Order;

   --------------
   -- Read_Bus --
   --------------

   procedure Read_Bus
     (Contenders : Contender_List;
      Lost_In    : Loss_List;
      P          : Place;
      Winner     : in out Contender_Index;
      Bus        : out Levels.Level) is
   begin
      Bus := Sends (Contenders, Winner, P);
      for I in Contenders'Range loop
         if Lost_In (I) = 0
           and then Sends (Contenders, I, P) = Levels.Dominant
         then
            Bus    := Levels.Dominant;
            Winner := I;
         end if;
         pragma Loop_Invariant
           (Winner in Contenders'Range
            and then Lost_In (Winner) = 0
            and then Sends (Contenders, Winner, P) = Bus);
         pragma Loop_Invariant
           (for all J in Contenders'First .. I =>
              (if Lost_In (J) = 0 and then Bus = Levels.Recessive
               then Sends (Contenders, J, P) = Levels.Recessive));
      end loop;
   end Read_Bus;

   -----------------
   -- Drop_Losers --
   -----------------

   procedure Drop_Losers
     (Contenders : Contender_List;
      P          : Place;
      Bus        : Levels.Level;
      Lost_In    : in out Loss_List) is
   begin
      for I in Contenders'Range loop
         if Lost_In (I) = 0 and then Sends (Contenders, I, P) /= Bus then
            Lost_In (I) := P;
         end if;
         pragma Loop_Invariant
           (for all J in Contenders'Range =>
              Lost_In (J) =
                (if J <= I
                   and then Lost_In'Loop_Entry (J) = 0
                   and then Sends (Contenders, J, P) /= Bus
                 then P else Lost_In'Loop_Entry (J)));
      end loop;
   end Drop_Losers;

   ---------------
   -- Arbitrate --
   ---------------

   procedure Arbitrate
     (Contenders : Contender_List;
      Winner     : out Contender_Index;
      Lost_In    : out Loss_List;
      Bus        : out Bus_Levels) is
   begin
      Winner  := Contenders'First;
      Lost_In := (others => 0);
      Bus     := (others => Levels.Recessive);
      for P in Place loop
         pragma Loop_Invariant
           (Winner in Contenders'Range and then Lost_In (Winner) = 0);
         pragma Loop_Invariant
           (for all I in Contenders'Range =>
              (if Lost_In (I) = 0
               then (for all Q in 1 .. P - 1 =>
                       Bus (Q) = Sends (Contenders, I, Q))));
         pragma Loop_Invariant
           (for all I in Contenders'Range =>
              Lost_In (I) < P
              and then
                (if Lost_In (I) = 0
                 then Prefix (Rank_Of (Contenders (I)), P - 1)
                   = Prefix (Rank_Of (Contenders (Winner)), P - 1)
                 else Prefix (Rank_Of (Contenders (I)), P - 1)
                   > Prefix (Rank_Of (Contenders (Winner)), P - 1)));
         pragma Loop_Invariant
           (for all I in Contenders'Range =>
              (if Lost_In (I) /= 0
               then Bus (Lost_In (I)) = Levels.Dominant
                 and then Sends (Contenders, I, Lost_In (I))
                   = Levels.Recessive));
         pragma Assert
           (for all I in Contenders'Range =>
              Prefix (Rank_Of (Contenders (I)), P - 1)
              = Prefix (Rank_Of (Contenders (I)), P) / 2);
         Read_Bus (Contenders, Lost_In, P, Winner, Bus (P));
         Drop_Losers (Contenders, P, Bus (P), Lost_In);
      end loop;
      Ranks_Are_Order (Contenders, Contenders (Winner));
   end Arbitrate;

end Ravenchart.Can.Arbitration;
