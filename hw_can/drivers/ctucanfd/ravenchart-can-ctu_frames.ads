--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Frames in the format of a CTU CAN FD core, in a transmit buffer and in its
--  receive buffer: "CTU CAN FD IP Core: Datasheet", chapter "CAN frame
--  format".
--
--  Guarantees   a frame that is converted there and back is the same; any
--               words have a meaning
--  Tasking      none: values
--  Timing       constant

with Interfaces;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fd_Frames;

package Ravenchart.Can.Ctu_Frames
  with SPARK_Mode, Pure
is
   use type Interfaces.Unsigned_8;
   use type Interfaces.Unsigned_32;
   use type Fd_Frames.Bit_Rate_Use;
   use type Fd_Frames.Sender_State;

   subtype Word is Interfaces.Unsigned_32;

   subtype Data_Word is Natural range 0 .. 15;
   --  DATA_1_4_W to DATA_61_64_W.

   type Data_Words is array (Data_Word) of Word;
   --  Four bytes in each, the first one lowest.

   type Image is record
      Layout     : Word := 0;
      Identity   : Word := 0;
      Stamp_Low  : Word := 0;
      Stamp_High : Word := 0;
      Data       : Data_Words := (others => 0);
   end record;
   --  FRAME_FORMAT_W, IDENTIFIER_W, TIMESTAMP_L_W, TIMESTAMP_U_W, data.

   subtype Word_Count is Natural range 1 .. 32;
   --  Words that a frame takes, FRAME_FORMAT_W included; 20 hold the longest
   --  one.

   function Words (Layout : Word) return Word_Count
   is (1 + Natural (Interfaces.Shift_Right (Layout, 11) and 16#1F#))
   with Global => null;
   --  RWCNT and one: the words of a received frame.

   Extended_Bit : constant Word := 2**6;   --  IDE
   Remote_Bit   : constant Word := 2**5;   --  RTR
   Fd_Bit       : constant Word := 2**7;   --  FDF
   Switch_Bit   : constant Word := 2**9;   --  BRS
   Passive_Bit  : constant Word := 2**10;  --  ESI_RSV

   function Is_Fd (I : Image) return Boolean
   is ((I.Layout and Fd_Bit) /= 0)
   with Global => null;
   --  Is it a CAN FD frame, not a classic one?

   function Format_Of (I : Image) return Frame_Format
   is (if (I.Layout and Extended_Bit) /= 0 then Extended else Standard)
   with Global => null;

   function Bits_Of (Identity : Word; Format : Frame_Format) return Word
   is (if Format = Extended
       then Identity and 16#1FFF_FFFF#
       else Interfaces.Shift_Right (Identity, 18) and 16#7FF#)
   with
     Global => null,
     Post   =>
       Bits_Of'Result
       <= (if Format = Extended then 16#1FFF_FFFF# else 16#7FF#);
   --  The identifier in IDENTIFIER_W. A standard one takes the bits of the
   --  upper eleven of an extended one.

   function Id_Of (I : Image) return Identifier
   is (Identifier (Bits_Of (I.Identity, Format_Of (I))))
   with Global => null, Post => Fits (Id_Of'Result, Format_Of (I));

   function Code_Of (I : Image) return Fd_Frames.Length_Code
   is (Fd_Frames.Length_Code (I.Layout and 16#F#))
   with Global => null;
   --  DLC.

   function Data_Byte
     (I : Image; Index : Fd_Frames.Fd_Index) return Interfaces.Unsigned_8
   is (Interfaces.Unsigned_8
         (Interfaces.Shift_Right (I.Data (Index / 4), 8 * (Index mod 4))
          and 16#FF#))
   with Global => null;

   function Timestamp (I : Image) return Interfaces.Unsigned_64
   is (Interfaces.Unsigned_64 (I.Stamp_Low)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (I.Stamp_High), 32))
   with Global => null;
   --  The time at which a frame was received, in ticks of the core's time
   --  base; in a frame to send, the time before which it waits.

   --  Classic frames

   function Frame_Of (I : Image) return Frame
   with
     Global => null,
     Pre    => not Is_Fd (I),
     Post   =>
       Frame_Of'Result.Id = Id_Of (I)
       and then Frame_Of'Result.Format = Format_Of (I)
       and then (Frame_Of'Result.Kind = Remote)
                = ((I.Layout and Remote_Bit) /= 0)
       and then Frame_Of'Result.Length
                = Natural'Min (8, Natural (Code_Of (I)))
       and then Payload (Frame_Of'Result)
                = (if Frame_Of'Result.Kind = Remote
                   then 0
                   else (Interfaces.Unsigned_64 (I.Data (0))
                         or Interfaces.Shift_Left
                              (Interfaces.Unsigned_64 (I.Data (1)), 32))
                        and Mask (Frame_Of'Result.Length));
   --  The frame that was received. A code above 8 means 8 bytes (ISO 11898-1);
   --  a remote frame has no data, whatever the words hold.

   function Image_Of (F : Frame) return Image
   with
     Global => null,
     Post   =>
       not Is_Fd (Image_Of'Result)
       and then Words (Image_Of'Result.Layout)
                = 4 + (if F.Kind = Remote then 0 else (F.Length + 3) / 4)
       and then Timestamp (Image_Of'Result) = 0
       and then Frame_Of (Image_Of'Result).Id = F.Id
       and then Frame_Of (Image_Of'Result).Format = F.Format
       and then Frame_Of (Image_Of'Result).Kind = F.Kind
       and then Frame_Of (Image_Of'Result).Length = F.Length
       and then Payload (Frame_Of (Image_Of'Result)) = Payload (F);
   --  The words of a transmit buffer to send F at once.

   --  CAN FD frames

   function Fd_Frame_Of (I : Image) return Fd_Frames.Fd_Frame
   with
     Global => null,
     Pre    => Is_Fd (I),
     Post   =>
       Fd_Frame_Of'Result.Id = Id_Of (I)
       and then Fd_Frame_Of'Result.Format = Format_Of (I)
       and then (Fd_Frame_Of'Result.Rate = Fd_Frames.Switched_Rate)
                = ((I.Layout and Switch_Bit) /= 0)
       and then (Fd_Frame_Of'Result.Sender = Fd_Frames.Passive_Sender)
                = ((I.Layout and Passive_Bit) /= 0)
       and then Fd_Frame_Of'Result.Length
                = Fd_Frames.Length_Of (Code_Of (I))
       and then
         (for all B in Fd_Frames.Fd_Index =>
            Fd_Frame_Of'Result.Bytes (B)
            = (if B < Fd_Frame_Of'Result.Length
               then Data_Byte (I, B) else 0));
   --  The frame that was received.

   function Image_Of (F : Fd_Frames.Fd_Frame) return Image
   with
     Global => null,
     Post   =>
       Is_Fd (Image_Of'Result)
       and then Words (Image_Of'Result.Layout) = 4 + (F.Length + 3) / 4
       and then Timestamp (Image_Of'Result) = 0
       and then Fd_Frame_Of (Image_Of'Result).Id = F.Id
       and then Fd_Frame_Of (Image_Of'Result).Format = F.Format
       and then Fd_Frame_Of (Image_Of'Result).Rate = F.Rate
       and then Fd_Frame_Of (Image_Of'Result).Sender = F.Sender
       and then Fd_Frame_Of (Image_Of'Result).Length = F.Length
       and then
         (for all B in Fd_Frames.Fd_Index =>
            Fd_Frames.Byte (Fd_Frame_Of (Image_Of'Result), B)
            = Fd_Frames.Byte (F, B));
   --  The words of a transmit buffer to send F at once.

   --  Frames of either family

   function Any_Frame_Of (I : Image) return Any_Frames.Any_Frame
   is (if Is_Fd (I)
       then Any_Frames.To_Any (Fd_Frame_Of (I))
       else Any_Frames.To_Any (Frame_Of (I)))
   with Global => null;

   function Image_Of (F : Any_Frames.Any_Frame) return Image
   is (case F.Family is
         when Any_Frames.Classic  => Image_Of (F.Plain),
         when Any_Frames.Flexible => Image_Of (F.Fd))
   with Global => null;

end Ravenchart.Can.Ctu_Frames;
