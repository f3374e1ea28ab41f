--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  CAN FD frames as values: up to 64 bytes, no remote frames.
--
--  Guarantees   the identifier of an Fd_Frame fits its format, and its length
--               has a length code; Byte is 0 beyond it
--  Tasking      none: frames are values
--  Timing       constant; Fd_Data_Frame and Words are linear in the room for
--               data

with Interfaces;

package Ravenchart.Can.Fd_Frames
  with SPARK_Mode, Pure
is
   use type Interfaces.Unsigned_8;

   subtype Fd_Length is Natural range 0 .. 64
   with
     Static_Predicate =>
       Fd_Length in 0 .. 8 | 12 | 16 | 20 | 24 | 32 | 48 | 64;
   --  Bytes in a CAN FD frame.

   type Length_Code is range 0 .. 15;
   --  The data length code (DLC) of a frame.

   function Code (Length : Fd_Length) return Length_Code
   is (case Length is
         when 0 .. 8 => Length_Code (Length),
         when 12     => 9,
         when 16     => 10,
         when 20     => 11,
         when 24     => 12,
         when 32     => 13,
         when 48     => 14,
         when 64     => 15)
   with Global => null;
   --  The code of Length.

   function Length_Of (Code : Length_Code) return Fd_Length
   is (case Code is
         when 0 .. 8 => Natural (Code),
         when 9      => 12,
         when 10     => 16,
         when 11     => 20,
         when 12     => 24,
         when 13     => 32,
         when 14     => 48,
         when 15     => 64)
   with
     Global => null,
     Post   => Fd_Frames.Code (Length_Of'Result) = Code;
   --  The length with this code.

   subtype Fd_Index is Natural range 0 .. 63;
   --  Byte 0 goes over the bus first.

   type Fd_Bytes is array (Fd_Index) of Interfaces.Unsigned_8;
   --  Room for the data of the longest frame.

   subtype Word_Index is Natural range 0 .. 7;

   type Fd_Words is array (Word_Index) of Interfaces.Unsigned_64;
   --  The same room as words of eight bytes each, byte 0 in the lowest eight
   --  bits of word 0, and so on, on every machine.

   function Byte
     (Words : Fd_Words; Index : Fd_Index) return Interfaces.Unsigned_8
   is (Interfaces.Unsigned_8
         (Interfaces.Shift_Right (Words (Index / 8), 8 * (Index mod 8))
          and 16#FF#))
   with Global => null;
   --  One byte of the words.

   function Ends_Within
     (Word : Interfaces.Unsigned_64; Length : Integer) return Boolean
   is (Length >= 8
       or else (Word and not Can.Mask (Integer'Max (Length, 0))) = 0)
   with Global => null;
   --  Are the bytes of a word from number Length on 0?

   function Ends_Within (Words : Fd_Words; Length : Fd_Length) return Boolean
   is (Ends_Within (Words (0), Length)
       and then Ends_Within (Words (1), Length - 8)
       and then Ends_Within (Words (2), Length - 16)
       and then Ends_Within (Words (3), Length - 24)
       and then Ends_Within (Words (4), Length - 32)
       and then Ends_Within (Words (5), Length - 40)
       and then Ends_Within (Words (6), Length - 48)
       and then Ends_Within (Words (7), Length - 56))
   with Global => null;
   --  Are the bytes from number Length on 0?

   type Bit_Rate_Use is (Constant_Rate, Switched_Rate);
   --  The bit rate switch (BRS): is the data phase sent at the data bit rate?

   type Sender_State is (Active_Sender, Passive_Sender);
   --  The error state indicator (ESI): is the sender error-passive?

   type Fd_Frame is record
      Id     : Identifier := 0;
      Format : Frame_Format := Can.Standard;
      Rate   : Bit_Rate_Use := Switched_Rate;
      Sender : Sender_State := Active_Sender;
      Length : Fd_Length := 0;
      Bytes  : Fd_Bytes := (others => 0);
   end record
   with Predicate => Fits (Id, Format);
   --  Bytes beyond Length have no meaning: read the data by Byte.

   function Byte
     (F : Fd_Frame; Index : Fd_Index) return Interfaces.Unsigned_8
   is (if Index < F.Length then F.Bytes (Index) else 0)
   with Global => null;
   --  One byte of the data; 0 beyond the length.

   function Word
     (F : Fd_Frame; Index : Word_Index) return Interfaces.Unsigned_64
   is (Interfaces.Unsigned_64 (Byte (F, 8 * Index))
       or Interfaces.Shift_Left
            (Interfaces.Unsigned_64 (Byte (F, 8 * Index + 1)), 8)
       or Interfaces.Shift_Left
            (Interfaces.Unsigned_64 (Byte (F, 8 * Index + 2)), 16)
       or Interfaces.Shift_Left
            (Interfaces.Unsigned_64 (Byte (F, 8 * Index + 3)), 24)
       or Interfaces.Shift_Left
            (Interfaces.Unsigned_64 (Byte (F, 8 * Index + 4)), 32)
       or Interfaces.Shift_Left
            (Interfaces.Unsigned_64 (Byte (F, 8 * Index + 5)), 40)
       or Interfaces.Shift_Left
            (Interfaces.Unsigned_64 (Byte (F, 8 * Index + 6)), 48)
       or Interfaces.Shift_Left
            (Interfaces.Unsigned_64 (Byte (F, 8 * Index + 7)), 56))
   with Global => null;
   --  Eight bytes of the data, the first one lowest.

   function Words (F : Fd_Frame) return Fd_Words
   with
     Global => null,
     Post   =>
       (for all I in Word_Index => Words'Result (I) = Word (F, I));
   --  The data as words; 0 beyond the length.

   function Fd_Data_Frame
     (Id     : Identifier;
      Format : Frame_Format;
      Length : Fd_Length;
      Bytes  : Fd_Bytes;
      Rate   : Bit_Rate_Use := Switched_Rate;
      Sender : Sender_State := Active_Sender) return Fd_Frame
   with
     Global => null,
     Pre    => Fits (Id, Format),
     Post   =>
       Fd_Data_Frame'Result.Id = Id
       and then Fd_Data_Frame'Result.Format = Format
       and then Fd_Data_Frame'Result.Rate = Rate
       and then Fd_Data_Frame'Result.Sender = Sender
       and then Fd_Data_Frame'Result.Length = Length
       and then
         (for all I in Fd_Index =>
            Fd_Data_Frame'Result.Bytes (I)
            = (if I < Length then Bytes (I) else 0));
   --  A frame whose unused bytes are 0, so that equal frames are equal.

   function Fd_Data_Frame
     (Id     : Identifier;
      Format : Frame_Format;
      Length : Fd_Length;
      Words  : Fd_Words;
      Rate   : Bit_Rate_Use) return Fd_Frame
   with
     Global => null,
     Pre    => Fits (Id, Format),
     Post   =>
       Fd_Data_Frame'Result.Id = Id
       and then Fd_Data_Frame'Result.Format = Format
       and then Fd_Data_Frame'Result.Rate = Rate
       and then Fd_Data_Frame'Result.Sender = Active_Sender
       and then Fd_Data_Frame'Result.Length = Length
       and then
         (for all I in Fd_Index =>
            Byte (Fd_Data_Frame'Result, I)
            = (if I < Length then Byte (Words, I) else 0))
       and then
         (if Ends_Within (Words, Length)
          then Fd_Frames.Words (Fd_Data_Frame'Result) = Words);
   --  The frame that carries Words; words beyond Length are not carried.

end Ravenchart.Can.Fd_Frames;
