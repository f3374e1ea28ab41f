--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Crcs
  with SPARK_Mode
is

   function Divided
     (Kind : Crc_Kind; Bits : Bit_Sequence; Last : Natural) return Register
   is (if Last = 0
       then 0
       else
         Brought_Down
           (Kind,
            Divided (Kind, Bits, Last - 1),
            Coefficient (Kind, Bits, Last)));

   function With_Zeros
     (Kind : Crc_Kind; R : Register; Zeros : Natural) return Register
   is (if Zeros = 0
       then R
       else
         Brought_Down
           (Kind, With_Zeros (Kind, R, Zeros - 1), Levels.Dominant));

   function After
     (Kind : Crc_Kind; Bits : Bit_Sequence; Last : Natural) return Register
   is (if Last = 0
       then Start (Kind)
       else Next (Kind, After (Kind, Bits, Last - 1), Bits (Last)));

   procedure Lemma_Sum (Kind : Crc_Kind; A, B : Register; Zeros : Natural)
   with
     Ghost,
     Global => null,
     Pre    => Is_Remainder (Kind, A) and then Is_Remainder (Kind, B),
     Post   =>
       Is_Remainder (Kind, A xor B)
       and then
         With_Zeros (Kind, A xor B, Zeros)
         = (With_Zeros (Kind, A, Zeros) xor With_Zeros (Kind, B, Zeros));
   --  The remainder of a sum is the sum of the remainders.

   procedure Lemma_First_Zero
     (Kind : Crc_Kind; R : Register; Zeros : Natural)
   with
     Ghost,
     Global => null,
     Pre    => Is_Remainder (Kind, R),
     Post   =>
       With_Zeros (Kind, Brought_Down (Kind, R, Levels.Dominant), Zeros)
       = Brought_Down
           (Kind, With_Zeros (Kind, R, Zeros), Levels.Dominant);
   --  A zero before the others is one behind them.

   procedure Lemma_One (Kind : Crc_Kind)
   with
     Ghost,
     Global => null,
     Post   =>
       With_Zeros (Kind, 1, Width (Kind)) = Polynomial (Kind)
       and then With_Zeros (Kind, 0, Width (Kind)) = 0;
   --  The change of the register by one bit.

   procedure Lemma_Bit (Kind : Crc_Kind; R : Register; Bit : Levels.Level)
   with
     Ghost,
     Global => null,
     Pre    => Is_Remainder (Kind, R),
     Post   =>
       With_Zeros (Kind, Brought_Down (Kind, R, Bit), Width (Kind))
       = Next (Kind, With_Zeros (Kind, R, Width (Kind)), Bit);
   --  One step of the register is one step of the division.

   ----------------------
   -- Lemma_Polynomial --
   ----------------------

   procedure Lemma_Polynomial (Kind : Crc_Kind) is null;

   ---------------
   -- Lemma_Sum --
   ---------------

   procedure Lemma_Sum (Kind : Crc_Kind; A, B : Register; Zeros : Natural)
   is
   begin
      for I in 1 .. Zeros loop
         pragma Loop_Invariant
           (With_Zeros (Kind, A xor B, I - 1)
            = (With_Zeros (Kind, A, I - 1)
               xor With_Zeros (Kind, B, I - 1)));
      end loop;
   end Lemma_Sum;

   ----------------------
   -- Lemma_First_Zero --
   ----------------------

   procedure Lemma_First_Zero
     (Kind : Crc_Kind; R : Register; Zeros : Natural)
   is
      Before : constant Register :=
        Brought_Down (Kind, R, Levels.Dominant);
   begin
      for I in 1 .. Zeros loop
         pragma Loop_Invariant
           (With_Zeros (Kind, Before, I - 1)
            = Brought_Down
                (Kind, With_Zeros (Kind, R, I - 1), Levels.Dominant));
      end loop;
   end Lemma_First_Zero;

   ---------------
   -- Lemma_One --
   ---------------

   procedure Lemma_One (Kind : Crc_Kind) is
   begin
      for I in 1 .. Width (Kind) loop
         pragma Loop_Invariant
           (With_Zeros (Kind, 1, I - 1) = Interfaces.Shift_Left (1, I - 1)
            and then With_Zeros (Kind, 0, I - 1) = 0);
      end loop;
   end Lemma_One;

   ---------------
   -- Lemma_Bit --
   ---------------

   procedure Lemma_Bit (Kind : Crc_Kind; R : Register; Bit : Levels.Level) is
      Zero : constant Register := Brought_Down (Kind, R, Levels.Dominant);
   begin
      Lemma_One (Kind);
      Lemma_First_Zero (Kind, R, Width (Kind));
      Lemma_Sum (Kind, Zero, Levels.Level'Pos (Bit), Width (Kind));
      pragma Assert
        (Brought_Down (Kind, R, Bit) = (Zero xor Levels.Level'Pos (Bit)));
   end Lemma_Bit;

   ---------------------
   -- Lemma_Remainder --
   ---------------------

   procedure Lemma_Remainder
     (Kind : Crc_Kind; Bits : Bit_Sequence; Last : Positive)
   is
   begin
      Lemma_One (Kind);
      Lemma_Bit (Kind, 0, Coefficient (Kind, Bits, 1));
      pragma Assert (Divided (Kind, Bits, 0) = 0);
      pragma Assert (After (Kind, Bits, 0) = Start (Kind));
      for I in 1 .. Last loop
         if I > 1 then
            Lemma_Bit (Kind, Divided (Kind, Bits, I - 1), Bits (I));
         end if;
         pragma Loop_Invariant
           (After (Kind, Bits, I)
            = With_Zeros (Kind, Divided (Kind, Bits, I), Width (Kind)));
      end loop;
   end Lemma_Remainder;

end Ravenchart.Can.Crcs;
