--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Frames as the bits that a transmitter puts on the bus, from the start of
--  frame to the end of the intermission.
--
--  Guarantees   dynamic stuff bits: after the first bit at most one for four
--               bits that are exposed to stuffing. All other bits are counted
--               exactly, so that a frame is never longer than its bound
--  Tasking      none: images are values
--  Timing       linear in the length of a frame
--
--  ISO 11898-1 (2015), MAC frame formats, CRC field, bit stuffing.

with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Levels;

package Ravenchart.Can.Wire
  with SPARK_Mode, Pure
is
   use type Fd_Frames.Bit_Rate_Use;

   Longest : constant := 736;
   --  Bits of the longest frame: extended CAN FD, 64 bytes, all stuffed.

   subtype Bit_Count is Natural range 0 .. Longest;
   --  Bits on the bus.

   subtype Bit_Index is Bit_Count range 1 .. Longest;
   --  Bit 1 is the start of frame.

   type Bit_Levels is array (Bit_Index) of Levels.Level;

   type Field is
     (Arbitration_Field,
      Format_Bits,
      Length_Bits,
      Data_Field,
      Check_Field,
      Check_Delimiter,
      Acknowledgement_Slot,
      Acknowledgement_Delimiter,
      End_Of_Frame,
      Intermission);
   --  The first field begins with the start of frame, and ends with the bits
   --  that Arbitration compares (IDE in a standard frame). Format_Bits: the
   --  bits up to the reserved bit, in CAN FD up to the bit rate switch.
   --  Length_Bits: the length code, in CAN FD after the error state indicator.
   --  Check_Field: stuff count and CRC, stuff bits included.

   type Field_Ends is array (Field) of Bit_Count;
   --  The last bit of each field.

   type Image is record
      Bits    : Bit_Levels := (others => Levels.Recessive);
      Ends    : Field_Ends := (others => 0);
      Stuffed : Bit_Count := 0;
   end record;
   --  Stuffed: the number of dynamic stuff bits. A transmitter sends the
   --  acknowledgement slot recessive.

   function Length (I : Image) return Bit_Count
   is (I.Ends (Intermission))
   with Global => null;
   --  All bits, the three of the intermission included.

   function Is_Ordered (I : Image) return Boolean
   is (I.Ends (Format_Bits) > 0
       and then I.Ends (Format_Bits) <= I.Ends (Check_Field)
       and then I.Ends (Check_Field) < I.Ends (Intermission))
   with Global => null;
   --  Does the check field end behind the head, and the frame behind it?

   Tail_Bits : constant := 13;
   --  From the delimiter of the CRC to the end of the intermission.

   function Head_Bits (Format : Frame_Format) return Bit_Count
   is (if Format = Can.Standard then 14 else 33)
   with Global => null;
   --  The start of frame and the bits that Arbitration compares.

   function Exposed_Bits (F : Frame) return Bit_Count
   is (Head_Bits (F.Format)
       + (if F.Format = Can.Standard then 5 else 6)
       + (if F.Kind = Data then 8 * F.Length else 0)
       + 15)
   with Global => null;
   --  The bits of a classic frame that are exposed to stuffing.

   function Exposed_Bits (F : Fd_Frames.Fd_Frame) return Bit_Count
   is (Head_Bits (F.Format) + 3 + 5 + 8 * F.Length)
   with Global => null;
   --  The bits of a CAN FD frame that are exposed to dynamic stuffing.

   function Check_Bits (Length : Fd_Frames.Fd_Length) return Bit_Count
   is (if Length <= 16 then 4 + 17 + 6 else 4 + 21 + 7)
   with Global => null;
   --  Stuff count, CRC and fixed stuff bits of a CAN FD frame.

   function To_Wire (F : Frame) return Image
   with
     Global => null,
     Post   =>
       Length (To_Wire'Result) =
         Exposed_Bits (F) + To_Wire'Result.Stuffed + Tail_Bits
       and then To_Wire'Result.Stuffed <= (Exposed_Bits (F) - 1) / 4
       and then Is_Ordered (To_Wire'Result);
   --  A classic frame. Every stuff bit is dynamic.

   function To_Wire (F : Fd_Frames.Fd_Frame) return Image
   with
     Global => null,
     Post   =>
       Length (To_Wire'Result) =
         Exposed_Bits (F) + To_Wire'Result.Stuffed
         + Check_Bits (F.Length) + Tail_Bits
       and then To_Wire'Result.Stuffed <= (Exposed_Bits (F) - 2) / 4
       and then Is_Ordered (To_Wire'Result)
       and then To_Wire'Result.Ends (Format_Bits)
         in Head_Bits (F.Format) + 3
            .. Head_Bits (F.Format) + 3 + (Head_Bits (F.Format) + 2) / 4;
   --  A CAN FD frame. Where five equal bits end the data, the first fixed
   --  stuff bit of the check field replaces the dynamic one.

   type Phases is record
      Nominal : Bit_Count := 0;
      Data    : Bit_Count := 0;
   end record
   with Predicate => Nominal + Data <= Longest;
   --  Bits at the nominal bit rate, and at the data bit rate.

   function Phases_Of (I : Image; Rate : Fd_Frames.Bit_Rate_Use)
     return Phases
   is (if Rate = Fd_Frames.Switched_Rate
       then (Nominal =>
               Length (I) - (I.Ends (Check_Field) - I.Ends (Format_Bits))
               - 1,
             Data    => I.Ends (Check_Field) - I.Ends (Format_Bits) + 1)
       else (Nominal => Length (I), Data => 0))
   with
     Global => null,
     Pre    => Is_Ordered (I);
   --  The data phase of a frame that switches its rate begins at the sample
   --  point of the bit of the switch and ends at that of the delimiter of the
   --  CRC. The nominal parts of these two bits make one nominal bit, the other
   --  parts one data bit (ISO 11898-1 (2015), bit rate switch). A classic
   --  frame has no data phase.

end Ravenchart.Can.Wire;
