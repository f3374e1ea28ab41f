--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The check sequences of CAN: CRC-15 for classic frames, CRC-17 for CAN FD
--  frames up to 16 bytes, CRC-21 for longer ones.
--
--  Guarantees   the register after a sequence of bits is the remainder of
--               their division by the generator (Lemma_Remainder)
--  Tasking      none: registers are values
--  Timing       constant
--
--  ISO 11898-1 (2015), CRC field. The registers of CAN FD start with a one
--  in their highest bit; with zeros only in the specification before it.

with Interfaces;
with Ravenchart.Can.Levels;

package Ravenchart.Can.Crcs
  with SPARK_Mode, Pure
is
   use type Interfaces.Unsigned_32;
   use type Levels.Level;

   type Crc_Kind is (Crc_15, Crc_17, Crc_21);
   --  The check sequences, named by their width.

   subtype Register is Interfaces.Unsigned_32;
   --  The sequence, in the lowest bits.

   function Width (Kind : Crc_Kind) return Positive
   is (case Kind is
         when Crc_15 => 15,
         when Crc_17 => 17,
         when Crc_21 => 21)
   with Global => null;
   --  Bits of the sequence.

   subtype Exponent is Natural range 0 .. 21;

   function Has_Term (Kind : Crc_Kind; Power : Exponent) return Boolean
   is (case Kind is
         when Crc_15 => Power in 15 | 14 | 10 | 8 | 7 | 4 | 3 | 0,
         when Crc_17 => Power in 17 | 16 | 14 | 13 | 11 | 6 | 4 | 3 | 1 | 0,
         when Crc_21 => Power in 21 | 20 | 13 | 11 | 7 | 4 | 3 | 0)
   with
     Ghost,
     Global => null;
   --  Is x**Power a term of the generator?

   function Polynomial (Kind : Crc_Kind) return Register
   is (case Kind is
         when Crc_15 => 16#4599#,
         when Crc_17 => 16#1_685B#,
         when Crc_21 => 16#10_2899#)
   with Global => null;
   --  The generator, without its highest term.

   procedure Lemma_Polynomial (Kind : Crc_Kind)
   with
     Ghost,
     Global => null,
     Post   =>
       Has_Term (Kind, Width (Kind))
       and then
         (for all Power in Exponent =>
            ((Interfaces.Shift_Right (Polynomial (Kind), Power) and 1) = 1)
            = (Power < Width (Kind) and then Has_Term (Kind, Power)));
   --  Polynomial has the terms of the generator, and Width is its degree.

   function Highest (Kind : Crc_Kind) return Register
   is (case Kind is
         when Crc_15 => 16#4000#,
         when Crc_17 => 16#1_0000#,
         when Crc_21 => 16#10_0000#)
   with
     Global => null,
     Post   =>
       Highest'Result = Interfaces.Shift_Left (1, Width (Kind) - 1);
   --  The highest bit of the sequence.

   function Is_Remainder (Kind : Crc_Kind; R : Register) return Boolean
   is (R < 2 * Highest (Kind))
   with
     Ghost,
     Global => null;
   --  Is the degree of R less than that of the generator?

   function Start (Kind : Crc_Kind) return Register
   is (if Kind = Crc_15 then 0 else Highest (Kind))
   with Global => null;
   --  The register before the first bit of a frame.

   function Next
     (Kind : Crc_Kind; R : Register; Bit : Levels.Level) return Register
   is ((2 * R and (2 * Highest (Kind) - 1))
       xor (if ((R and Highest (Kind)) /= 0)
              xor (Bit = Levels.Recessive)
            then Polynomial (Kind)
            else 0))
   with Global => null, Post => Is_Remainder (Kind, Next'Result);
   --  The register after one bit more.

   --  The definition of ISO 11898-1: the bits, and behind them as many zeros
   --  as the sequence is wide, are the coefficients of a polynomial. The
   --  sequence is the remainder of its division by the generator, modulo 2. In
   --  CAN FD the first bit is inverted: the one at the start does that.

   type Bit_Sequence is array (Positive range <>) of Levels.Level
   with Ghost;

   function Brought_Down
     (Kind : Crc_Kind; R : Register; Bit : Levels.Level) return Register
   is ((2 * R + Levels.Level'Pos (Bit))
       xor (if (R and Highest (Kind)) /= 0
            then 2 * Highest (Kind) + Polynomial (Kind)
            else 0))
   with
     Ghost,
     Global => null,
     Pre    => Is_Remainder (Kind, R),
     Post   => Is_Remainder (Kind, Brought_Down'Result);
   --  One step of the division: the next coefficient comes down behind the
   --  remainder R, and the generator is subtracted where its highest term is
   --  reached.

   function Coefficient
     (Kind : Crc_Kind; Bits : Bit_Sequence; Place : Positive)
      return Levels.Level
   is (if Place = 1 and then Kind /= Crc_15
       then Levels.Inverse (Bits (Place))
       else Bits (Place))
   with
     Ghost,
     Global => null,
     Pre    => Place in Bits'Range;
   --  The coefficient of the bit at Place in the division.

   function Divided
     (Kind : Crc_Kind; Bits : Bit_Sequence; Last : Natural) return Register
   with
     Ghost,
     Global             => null,
     Pre                => Bits'First = 1 and then Last <= Bits'Last,
     Post               => Is_Remainder (Kind, Divided'Result),
     Subprogram_Variant => (Decreases => Last);
   --  The remainder of the bits 1 .. Last without zeros behind them.

   function With_Zeros
     (Kind : Crc_Kind; R : Register; Zeros : Natural) return Register
   with
     Ghost,
     Global             => null,
     Pre                => Is_Remainder (Kind, R),
     Post               => Is_Remainder (Kind, With_Zeros'Result),
     Subprogram_Variant => (Decreases => Zeros);
   --  The remainder when so many zeros follow the bits with the remainder R.

   function After
     (Kind : Crc_Kind; Bits : Bit_Sequence; Last : Natural) return Register
   with
     Ghost,
     Global             => null,
     Pre                => Bits'First = 1 and then Last <= Bits'Last,
     Post               => Is_Remainder (Kind, After'Result),
     Subprogram_Variant => (Decreases => Last);
   --  The register after the bits 1 .. Last.

   procedure Lemma_Remainder
     (Kind : Crc_Kind; Bits : Bit_Sequence; Last : Positive)
   with
     Ghost,
     Global => null,
     Pre    => Bits'First = 1 and then Last <= Bits'Last,
     Post   =>
       After (Kind, Bits, Last)
       = With_Zeros (Kind, Divided (Kind, Bits, Last), Width (Kind));
   --  The register is the remainder.

end Ravenchart.Can.Crcs;
