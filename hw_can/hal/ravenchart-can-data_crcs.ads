--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Cyclic redundancy checks over the data of a frame, for the protection of
--  messages from end to end.
--
--  Guarantees   Crc is the division of the bytes, first bit first, by the
--               generator of its kind
--  Tasking      none: registers are values
--  Timing       linear in the bytes
--
--  AUTOSAR CP SWS_CRCLibrary: CRC-8 SAE J1850, CRC-8 with the generator 2F
--  (CRC8H2F), and CRC-16 CCITT with false start (start value FFFF).

with Interfaces;
with Ravenchart.Can.Fd_Frames;

package Ravenchart.Can.Data_Crcs
  with SPARK_Mode, Pure
is
   use type Interfaces.Unsigned_8;
   use type Interfaces.Unsigned_16;

   type Data_Crc_Kind is (Crc_8_J1850, Crc_8_H2f, Crc_16_Ccitt);

   subtype Register is Interfaces.Unsigned_16;
   --  The remainder, in the highest bits: a CRC of 8 bits has 0 in the low
   --  byte, so that one step serves all kinds.

   function Polynomial (Kind : Data_Crc_Kind) return Register
   is (case Kind is
         when Crc_8_J1850  => 16#1D00#,
         when Crc_8_H2f    => 16#2F00#,
         when Crc_16_Ccitt => 16#1021#)
   with Global => null;
   --  The generator, without its highest term.

   function After_Bit (Kind : Data_Crc_Kind; R : Register) return Register
   is (Interfaces.Shift_Left (R, 1)
       xor (if (R and 16#8000#) /= 0 then Polynomial (Kind) else 0))
   with Global => null;
   --  The register after one more bit.

   function After_Four (Kind : Data_Crc_Kind; R : Register) return Register
   is (After_Bit
         (Kind,
          After_Bit (Kind, After_Bit (Kind, After_Bit (Kind, R)))))
   with Global => null;

   function After_Byte
     (Kind : Data_Crc_Kind; R : Register; Byte : Interfaces.Unsigned_8)
      return Register
   is (After_Four
         (Kind,
          After_Four
            (Kind,
             R xor Interfaces.Shift_Left (Interfaces.Unsigned_16 (Byte), 8))))
   with Global => null;
   --  The register after one more byte, its highest bit first.

   function After_Bytes
     (Kind  : Data_Crc_Kind;
      R     : Register;
      Data  : Fd_Frames.Fd_Bytes;
      First : Fd_Frames.Fd_Index;
      Past  : Natural) return Register
   with
     Ghost,
     Global             => null,
     Pre                => Past <= Data'Length,
     Subprogram_Variant => (Decreases => Past);
   --  The register after the bytes First to Past - 1: R itself if there are
   --  none, else one more byte after those before it.

   function Run
     (Kind  : Data_Crc_Kind;
      R     : Register;
      Data  : Fd_Frames.Fd_Bytes;
      First : Fd_Frames.Fd_Index;
      Past  : Natural) return Register
   with
     Global => null,
     Pre    => Past <= Data'Length,
     Post   => Run'Result = After_Bytes (Kind, R, Data, First, Past);
   --  The register after the bytes First to Past - 1.

   procedure Lemma_Same_Register
     (Kind  : Data_Crc_Kind;
      R     : Register;
      A, B  : Fd_Frames.Fd_Bytes;
      First : Fd_Frames.Fd_Index;
      Past  : Natural)
   with
     Ghost,
     Global => null,
     Pre    =>
       Past <= A'Length
       and then (for all I in First .. Past - 1 => A (I) = B (I)),
     Post   =>
       After_Bytes (Kind, R, A, First, Past)
       = After_Bytes (Kind, R, B, First, Past);
   --  The register depends on these bytes alone.

end Ravenchart.Can.Data_Crcs;
