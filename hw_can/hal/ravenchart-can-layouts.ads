--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Layout tables: the position of a signal in the data of a frame, the meaning
--  of its bits, and the frame that carries the data, in the terms of CAN
--  databases (DBC). Contracts of generated code are stated by these tables;
--  the bodies of codecs and of senders do not use them.
--
--  Guarantees   the meaning of a row is defined here, once for all models
--  Tasking      none: tables are constants
--  Timing       constant

with Interfaces;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fd_Frames;

package Ravenchart.Can.Layouts
  with SPARK_Mode, Pure
is
   type Byte_Order is (Intel, Motorola);
   --  Intel: Start is the least significant bit, and the signal goes upwards.
   --  Motorola: Start is the most significant bit. The signal goes down to bit
   --  0 of its byte, then on from bit 7 of the next byte.

   subtype Bit_Index is Natural range 0 .. 511;
   --  Bit 0 is the least significant bit of byte 0, bit 8 that of byte 1.

   subtype Bit_Count is Positive range 1 .. 64;

   type Signal is record
      Start  : Bit_Index;
      Width  : Bit_Count;
      Order  : Byte_Order;
      Signed : Boolean;
      Offset : Number'Base;
   end record;
   --  One row: value = raw value + Offset; the raw value has Width bits, in
   --  two's complement where it is Signed.

   function First_In_Order (S : Signal) return Bit_Index
   is (if S.Order = Intel
       then S.Start
       else 8 * (S.Start / 8) + 7 - S.Start mod 8)
   with Global => null;
   --  The number of bit Start, counted in the direction of the byte order.

   function Reaches_To (S : Signal) return Natural
   is (First_In_Order (S) + S.Width)
   with Global => null;
   --  Bits of the frame up to the end of the signal, in that direction.

   function Mask (Width : Natural) return Interfaces.Unsigned_64
   is (Interfaces.Shift_Right (Interfaces.Unsigned_64'Last, 64 - Width))
   with
     Global => null,
     Pre    => Width <= 64,
     Post   => (if Width <= 62 then Mask'Result < 2**62);
   --  A mask of so many bits, all of them 1.

   function Reversed
     (Word : Interfaces.Unsigned_64) return Interfaces.Unsigned_64
   is (Interfaces.Shift_Right (Word, 56)
       or (Interfaces.Shift_Right (Word, 40) and 16#FF00#)
       or (Interfaces.Shift_Right (Word, 24) and 16#FF_0000#)
       or (Interfaces.Shift_Right (Word, 8) and 16#FF00_0000#)
       or (Interfaces.Shift_Left (Word, 8) and 16#FF_0000_0000#)
       or (Interfaces.Shift_Left (Word, 24) and 16#FF00_0000_0000#)
       or (Interfaces.Shift_Left (Word, 40) and 16#FF_0000_0000_0000#)
       or Interfaces.Shift_Left (Word, 56))
   with Global => null;
   --  The eight bytes of a word in the opposite order.

   function Raw
     (Word : Interfaces.Unsigned_64; S : Signal) return Interfaces.Unsigned_64
   is ((if S.Order = Intel
        then Interfaces.Shift_Right (Word, S.Start)
        else Interfaces.Shift_Right (Reversed (Word), 64 - Reaches_To (S)))
       and Mask (S.Width))
   with Global => null, Pre => Reaches_To (S) <= 64;
   --  The bits of a signal of a frame of up to eight bytes.

   function Joined
     (Words : Fd_Frames.Fd_Words; S : Signal) return Interfaces.Unsigned_64
   is (if S.Order = Intel
       then
         Interfaces.Shift_Right (Words (S.Start / 64), S.Start mod 64)
         or Interfaces.Shift_Left
              (Words (S.Start / 64 + 1), 64 - S.Start mod 64)
       else
         Interfaces.Shift_Left
           (Reversed (Words (First_In_Order (S) / 64)),
            Reaches_To (S) mod 64)
         or Interfaces.Shift_Right
              (Reversed (Words (First_In_Order (S) / 64 + 1)),
               64 - Reaches_To (S) mod 64))
   with
     Global => null,
     Pre    =>
       Reaches_To (S) <= 512
       and then First_In_Order (S) / 64 < (Reaches_To (S) - 1) / 64;
   --  The bits of a signal in two neighbouring words; other bits above them.

   function Raw
     (Words : Fd_Frames.Fd_Words; S : Signal) return Interfaces.Unsigned_64
   is ((if First_In_Order (S) / 64 < (Reaches_To (S) - 1) / 64
        then Joined (Words, S)
        elsif S.Order = Intel
        then Interfaces.Shift_Right (Words (S.Start / 64), S.Start mod 64)
        else
          Interfaces.Shift_Right
            (Reversed (Words (S.Start / 64)),
             63 - (Reaches_To (S) - 1) mod 64))
       and Mask (S.Width))
   with Global => null, Pre => Reaches_To (S) <= 512;
   --  The bits of a signal of a longer frame.

   function Counted
     (Raw : Interfaces.Unsigned_64; S : Signal) return Number'Base
   is (if Raw >= 2**62
       then 2**62
       elsif S.Signed and then Raw > Mask (S.Width - 1)
       then Number'Base (Raw) - Number'Base (Mask (S.Width)) - 1
       else Number'Base (Raw))
   with Global => null, Pre => (if S.Signed then S.Width <= 62);
   --  The raw value of these bits; 2**62 for values beyond the range of
   --  models.

   function Number_In
     (Word : Interfaces.Unsigned_64; S : Signal) return Number'Base
   is (Counted (Raw (Word, S), S))
   with
     Global => null,
     Pre    =>
       Reaches_To (S) <= 64 and then (if S.Signed then S.Width <= 62);
   --  The raw value of a signal of a frame of up to eight bytes.

   function Number_In
     (Words : Fd_Frames.Fd_Words; S : Signal) return Number'Base
   is (Counted (Raw (Words, S), S))
   with
     Global => null,
     Pre    =>
       Reaches_To (S) <= 512 and then (if S.Signed then S.Width <= 62);
   --  The raw value of a signal of a longer frame.

   type Frame_Row is record
      Family : Any_Frames.Frame_Family;
      Id     : Identifier;
      Format : Frame_Format;
      Length : Fd_Frames.Fd_Length;
   end record;
   --  The frame of a message: its identifier, and its bytes of data.

   function Holds (R : Frame_Row; S : Signal) return Boolean
   is (Reaches_To (S) <= 8 * R.Length)
   with Global => null;
   --  Is the whole signal in the data of the frame?

   function Is_Framed (F : Any_Frames.Any_Frame; R : Frame_Row) return Boolean
   is (Any_Frames.Carries (F, R.Family, R.Length)
       and then Any_Frames.Id (F) = R.Id
       and then Any_Frames.Format (F) = R.Format)
   with Global => null;
   --  Is it the data frame of the row?

end Ravenchart.Can.Layouts;
