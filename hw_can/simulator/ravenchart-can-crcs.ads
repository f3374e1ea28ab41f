--  The check sequences of CAN: CRC-15 for classic frames, CRC-17 for CAN FD
--  frames up to 16 bytes, CRC-21 for longer ones.
--
--  Guarantees   Next is the step of the register that the standard gives
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
   --  Named by the width of the sequence.

   subtype Register is Interfaces.Unsigned_32;
   --  The sequence, in its lowest bits.

   function Width (Kind : Crc_Kind) return Positive
   is (case Kind is
         when Crc_15 => 15,
         when Crc_17 => 17,
         when Crc_21 => 21)
   with Global => null;
   --  Bits of the sequence.

   function Polynomial (Kind : Crc_Kind) return Register
   is (case Kind is
         when Crc_15 => 16#4599#,
         when Crc_17 => 16#1_685B#,
         when Crc_21 => 16#10_2899#)
   with Global => null;
   --  The generator, without its highest term.

   function Highest (Kind : Crc_Kind) return Register
   is (case Kind is
         when Crc_15 => 16#4000#,
         when Crc_17 => 16#1_0000#,
         when Crc_21 => 16#10_0000#)
   with Global => null;
   --  The highest bit of the sequence.

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
   with Global => null;
   --  The register after one bit more.

end Ravenchart.Can.Crcs;
