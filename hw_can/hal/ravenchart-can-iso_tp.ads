--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  ISO-TP: values longer than a frame, as segments on classic CAN buses (ISO
--  15765-2, normal addressing). This package has the segments; its child
--  packages are the two ends of a transfer.
--
--  Guarantees   Decoded is total: data that are no segment are Unknown
--  Tasking      none: segments are values
--  Timing       constant

with Interfaces;
with Ravenchart.Can.Fd_Frames;

package Ravenchart.Can.Iso_Tp
  with SPARK_Mode, Pure
is
   use type Interfaces.Unsigned_8;

   subtype Octet is Interfaces.Unsigned_8;

   subtype Value_Length is Positive range 1 .. 64;
   --  Bytes of a value.

   subtype Byte_Count is Natural range 0 .. 64;

   subtype Value_Bytes is Fd_Frames.Fd_Bytes;
   --  Room for the longest value.

   Padding : constant Octet := 16#CC#;
   --  Fills a segment up to eight bytes.

   type Sequence_Number is mod 16;

   subtype Block_Size is Natural range 0 .. 255;
   --  Consecutive frames before the next flow control; 0 for all the rest.

   type Flow_Status is (Continue_To_Send, Wait, Overflow, Invalid);
   --  Invalid: a reserved status.

   subtype Microseconds is Natural range 0 .. 127_000;
   --  The separation time STmin.

   type Segment_Kind is
     (Single, First, Consecutive, Flow_Control, Unknown);

   subtype Announced_Length is Natural range 0 .. 4_095;

   type Segment is record
      Kind       : Segment_Kind := Unknown;
      Length     : Announced_Length := 0;
      Sequence   : Sequence_Number := 0;
      Status     : Flow_Status := Invalid;
      Block      : Block_Size := 0;
      Separation : Microseconds := 0;
   end record;
   --  Length belongs to single and first frames, Sequence to consecutive ones,
   --  the last three to flow control.

   function Octet_Of
     (Payload : Interfaces.Unsigned_64; Index : Byte_Index) return Octet
   is (Octet (Interfaces.Shift_Right (Payload, 8 * Index) and 16#FF#))
   with Global => null;
   --  One byte of the data of a frame.

   type Frame_Octets is array (Byte_Index) of Octet;

   function Payload_Of (Item : Frame_Octets) return Interfaces.Unsigned_64
   is (Interfaces.Unsigned_64 (Item (0))
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (Item (1)), 8)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (Item (2)), 16)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (Item (3)), 24)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (Item (4)), 32)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (Item (5)), 40)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (Item (6)), 48)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (Item (7)), 56))
   with
     Global => null,
     Post   =>
       Octet_Of (Payload_Of'Result, 0) = Item (0)
       and then Octet_Of (Payload_Of'Result, 1) = Item (1)
       and then Octet_Of (Payload_Of'Result, 2) = Item (2)
       and then Octet_Of (Payload_Of'Result, 3) = Item (3)
       and then Octet_Of (Payload_Of'Result, 4) = Item (4)
       and then Octet_Of (Payload_Of'Result, 5) = Item (5)
       and then Octet_Of (Payload_Of'Result, 6) = Item (6)
       and then Octet_Of (Payload_Of'Result, 7) = Item (7)
       and then
         (for all I in Byte_Index =>
            (case I is
               when 0 => Octet_Of (Payload_Of'Result, I) = Item (I),
               when 1 => Octet_Of (Payload_Of'Result, I) = Item (I),
               when 2 => Octet_Of (Payload_Of'Result, I) = Item (I),
               when 3 => Octet_Of (Payload_Of'Result, I) = Item (I),
               when 4 => Octet_Of (Payload_Of'Result, I) = Item (I),
               when 5 => Octet_Of (Payload_Of'Result, I) = Item (I),
               when 6 => Octet_Of (Payload_Of'Result, I) = Item (I),
               when 7 => Octet_Of (Payload_Of'Result, I) = Item (I)));
   --  The data of a frame from its bytes.

   function Separation_Of (Code : Octet) return Microseconds
   is (case Code is
         when 0 .. 16#7F#      => 1_000 * Natural (Code),
         when 16#F1# .. 16#F9# => 100 * (Natural (Code) - 16#F0#),
         when others           => 127_000)
   with Global => null;
   --  STmin from its code; a reserved one counts as the longest.

   function Decoded
     (Payload : Interfaces.Unsigned_64; Length : Data_Length) return Segment
   with
     Global => null,
     Post   =>
       (case Decoded'Result.Kind is
          when Single       =>
            Decoded'Result.Length in 1 .. 7
            and then Decoded'Result.Length < Length,
          when First        => Length = 8,
          when Consecutive  => Length >= 2,
          when Flow_Control => Length >= 3,
          when Unknown      => True);
   --  The segment in a frame of Length bytes. A first frame of a value of more
   --  than 4,095 bytes has the length 0.

   function Flow_Payload
     (Status : Flow_Status; Block : Block_Size; Code : Octet)
      return Interfaces.Unsigned_64
   is (Payload_Of
         ((0      =>
             (case Status is
                when Continue_To_Send => 16#30#,
                when Wait             => 16#31#,
                when Overflow         => 16#32#,
                when Invalid          => 16#3F#),
           1      => Octet (Block),
           2      => Code,
           others => Padding)))
   with Global => null;
   --  A frame of flow control, with the code of STmin.

   function Words_Of (Item : Value_Bytes) return Fd_Frames.Fd_Words
   with
     Global => null,
     Post   =>
       (for all I in Fd_Frames.Fd_Index =>
          Fd_Frames.Byte (Words_Of'Result, I) = Item (I));
   --  The bytes as the words of a codec.

   function Bytes_Of (Item : Fd_Frames.Fd_Words) return Value_Bytes
   with
     Global => null,
     Post   =>
       (for all I in Fd_Frames.Fd_Index =>
          Bytes_Of'Result (I) = Fd_Frames.Byte (Item, I));
   --  The words of a codec as bytes.

end Ravenchart.Can.Iso_Tp;
