--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Frames in the format of the FIFOs of the CAN controller of Zynq-7000 and
--  Zynq UltraScale+: UG585 and UG1085, registers TXFIFO_ID to RXFIFO_DATA2.
--
--  Guarantees   a frame that is converted there and back is the same; any
--               words have a meaning
--  Tasking      none: values
--  Timing       constant

with Interfaces;

package Ravenchart.Can.Xcan_Frames
  with SPARK_Mode, Pure
is
   use type Interfaces.Unsigned_32;

   subtype Word is Interfaces.Unsigned_32;

   type Image is record
      Identity  : Word := 0;
      Layout    : Word := 0;
      Data_Low  : Word := 0;
      Data_High : Word := 0;
   end record;
   --  ID, DLC, DATA1 and DATA2. Byte 0 is the highest byte of DATA1.

   Remote_Standard : constant Word := 2**20;  --  SRRRTR
   Extended_Bit    : constant Word := 2**19;  --  IDE
   Remote_Extended : constant Word := 2**0;   --  RTR

   function Format_Of (I : Image) return Frame_Format
   is (if (I.Identity and Extended_Bit) /= 0 then Extended else Standard)
   with Global => null;

   function Kind_Of (I : Image) return Frame_Kind
   is (if (I.Identity
           and (if Format_Of (I) = Extended
                then Remote_Extended else Remote_Standard)) /= 0
       then Remote else Data)
   with Global => null;
   --  SRRRTR of an extended frame is the bit SRR, which has no meaning.

   function Bits_Of (Identity : Word) return Word
   is (if (Identity and Extended_Bit) /= 0
       then (Interfaces.Shift_Right (Identity, 3) and 16#1FFC_0000#)
            or (Interfaces.Shift_Right (Identity, 1) and 16#3_FFFF#)
       else Interfaces.Shift_Right (Identity, 21))
   with
     Global => null,
     Post   =>
       (if (Identity and Extended_Bit) /= 0
        then Bits_Of'Result <= 16#1FFF_FFFF#
        else Bits_Of'Result <= 16#7FF#);
   --  IDH has the upper eleven bits, IDL the lower 18 of an extended one.

   function Id_Of (I : Image) return Identifier
   is (Identifier (Bits_Of (I.Identity)))
   with Global => null, Post => Fits (Id_Of'Result, Format_Of (I));

   function Length_Of (I : Image) return Data_Length
   is (Natural'Min (8, Natural (Interfaces.Shift_Right (I.Layout, 28))))
   with Global => null;
   --  DLC. A code above 8 means 8 bytes (ISO 11898-1).

   function Swapped (Value : Word) return Word
   is (Interfaces.Shift_Left (Value, 24)
       or (Interfaces.Shift_Left (Value, 8) and 16#00FF_0000#)
       or (Interfaces.Shift_Right (Value, 8) and 16#0000_FF00#)
       or Interfaces.Shift_Right (Value, 24))
   with Global => null;
   --  The four bytes of Value in the opposite order.

   function Data_Of (I : Image) return Interfaces.Unsigned_64
   is (Interfaces.Unsigned_64 (Swapped (I.Data_Low))
       or Interfaces.Shift_Left
            (Interfaces.Unsigned_64 (Swapped (I.Data_High)), 32))
   with Global => null;
   --  The eight bytes of data, byte 0 lowest.

   function Frame_Of (I : Image) return Frame
   is ((Id     => Id_Of (I),
        Format => Format_Of (I),
        Kind   => Kind_Of (I),
        Length => Length_Of (I),
        Bits   =>
          (if Kind_Of (I) = Remote
           then 0 else Data_Of (I) and Mask (Length_Of (I)))))
   with Global => null;
   --  The frame that was received. A remote frame has no data, whatever the
   --  words hold.

   function Image_Of (F : Frame) return Image
   with
     Global => null,
     Post   =>
       Frame_Of (Image_Of'Result).Id = F.Id
       and then Frame_Of (Image_Of'Result).Format = F.Format
       and then Frame_Of (Image_Of'Result).Kind = F.Kind
       and then Frame_Of (Image_Of'Result).Length = F.Length
       and then Payload (Frame_Of (Image_Of'Result)) = Payload (F);
   --  The words of the transmit FIFO to send F.

end Ravenchart.Can.Xcan_Frames;
