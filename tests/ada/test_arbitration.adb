--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Arbitration: the frame that stays on the bus, and the place at which the
--  others lose.

with Facts;
with Interfaces;
with Ravenchart.Can;
with Ravenchart.Can.Arbitration;
with Ravenchart.Can.Levels;
with Ravenchart.Can.Wire;

procedure Test_Arbitration is
   use Ravenchart.Can;
   use Ravenchart.Can.Arbitration;
   use type Interfaces.Unsigned_64;
   use type Levels.Level;

   Base : constant Frame_Format := Ravenchart.Can.Standard;
   --  The literal alone would be hidden by package Standard.

   Seed : Interfaces.Unsigned_64 := 1;

   function Random return Interfaces.Unsigned_64;
   --  The next number of a linear congruential generator.

   function Random_Contender return Contender;
   --  Any format and kind; few identifiers, so that many are close.

   function Loses_In (First, Second : Contender) return Loss;
   --  The place at which Second loses; 0 when it does not.

   function Is_Right (Contenders : Contender_List) return Boolean;
   --  Does the contest end as the rules for pairs require?

   procedure Check_Rules;

   procedure Check_Contests;

   procedure Check_Wire;

   ------------
   -- Random --
   ------------

   function Random return Interfaces.Unsigned_64 is
   begin
      Seed := Seed * 6_364_136_223_846_793_005 + 1_442_695_040_888_963_407;
      return Interfaces.Rotate_Left (Seed, 31);
   end Random;

   ----------------------
   -- Random_Contender --
   ----------------------

   function Random_Contender return Contender is
      Leading : constant Identifier := Identifier (Random mod 4);
      Rest    : constant Identifier := Identifier (Random mod 4);
      Kind    : constant Frame_Kind :=
        (if Random mod 2 = 0 then Data else Remote);
   begin
      return
        (if Random mod 2 = 0 then (Leading, Base, Kind)
         else (Leading * 2**18 + Rest, Extended, Kind));
   end Random_Contender;

   --------------
   -- Loses_In --
   --------------

   function Loses_In (First, Second : Contender) return Loss is
      Winner  : Contender_Index;
      Lost_In : Loss_List (1 .. 2);
      Bus     : Bus_Levels;
   begin
      Arbitrate ((First, Second), Winner, Lost_In, Bus);
      return Lost_In (2);
   end Loses_In;

   --------------
   -- Is_Right --
   --------------

   function Is_Right (Contenders : Contender_List) return Boolean is
      Winner  : Contender_Index;
      Lost_In : Loss_List (Contenders'Range);
      Bus     : Bus_Levels;
   begin
      Arbitrate (Contenders, Winner, Lost_In, Bus);
      return
        (for all I in Contenders'Range =>
           not Precedes (Contenders (I), Contenders (Winner))
           and then
             (Lost_In (I) = 0) = (Contenders (I) = Contenders (Winner)));
   end Is_Right;

   -----------------
   -- Check_Rules --
   -----------------

   procedure Check_Rules is
      Low : constant Contender := (16#123#, Base, Data);
   begin
      Facts.Check
        ("of two identifiers the lower one wins, where they differ",
         Loses_In (Low, (16#125#, Base, Data)) = 9
         and then Loses_In ((16#125#, Base, Data), Low) = 0);
      Facts.Check
        ("a data frame wins over its remote frame at RTR",
         Loses_In (Low, (16#123#, Base, Remote)) = 12);
      Facts.Check
        ("a standard data frame wins over an extended one at SRR",
         Loses_In (Low, (16#123# * 2**18, Extended, Data)) = 12);
      Facts.Check
        ("a standard remote frame wins over an extended one at IDE",
         Loses_In
           ((16#123#, Base, Remote), (16#123# * 2**18, Extended, Data))
         = 13);
      Facts.Check
        ("an extended frame with lower leading bits wins over a standard one",
         Loses_In ((16#122# * 2**18 + 2**18 - 1, Extended, Remote), Low)
         = 11);
      Facts.Check
        ("an extended data frame wins over its remote frame at RTR",
         Loses_In ((5, Extended, Data), (5, Extended, Remote)) = 32);
      Facts.Check
        ("frames that are alike both stay", Loses_In (Low, Low) = 0);
   end Check_Rules;

   --------------------
   -- Check_Contests --
   --------------------

   procedure Check_Contests is
      Right : Boolean := True;
   begin
      for Size in Contender_Index range 1 .. 12 loop
         for Round in 1 .. 200 loop
            declare
               Contenders : Contender_List (1 .. Size);
            begin
               for C of Contenders loop
                  C := Random_Contender;
               end loop;
               Right := Right and then Is_Right (Contenders);
            end;
         end loop;
      end loop;
      Facts.Check ("2400 random contests go to the first in order", Right);
   end Check_Contests;

   ----------------
   -- Check_Wire --
   ----------------

   procedure Check_Wire is
      Right : Boolean := True;

      function First_Difference (A, B : Wire.Image) return Levels.Level;
      --  The bit of A at the first difference of the bits on the bus.

      function First_Difference (A, B : Wire.Image) return Levels.Level is
      begin
         for I in A.Bits'Range loop
            if A.Bits (I) /= B.Bits (I) then
               return A.Bits (I);
            end if;
         end loop;
         return Levels.Recessive;
      end First_Difference;

      function Image_Of (C : Contender) return Wire.Image
      is (Wire.To_Wire
            (if C.Kind = Data then Data_Frame (C.Id, C.Format, 0, 0)
             else Remote_Frame (C.Id, C.Format, 0)));

      A, B : Contender;
   begin
      for Round in 1 .. 2000 loop
         A     := Random_Contender;
         B     := Random_Contender;
         Right := Right
           and then
             (if Precedes (A, B)
              then First_Difference (Image_Of (A), Image_Of (B))
                = Levels.Dominant);
      end loop;
      Facts.Check
        ("2000 pairs are decided alike by the stuffed bits on the bus",
         Right);
   end Check_Wire;

begin
   Check_Rules;
   Check_Contests;
   Check_Wire;
   Facts.Finish;
end Test_Arbitration;
