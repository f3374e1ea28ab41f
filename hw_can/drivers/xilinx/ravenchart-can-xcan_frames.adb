--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Xcan_Frames
  with SPARK_Mode
is
   function Identity_Of (F : Frame) return Word
   with
     Post =>
       Format_Of ((Identity => Identity_Of'Result, others => 0)) = F.Format
       and then Kind_Of ((Identity => Identity_Of'Result, others => 0))
                = F.Kind
       and then Id_Of ((Identity => Identity_Of'Result, others => 0)) = F.Id;
   --  ID.

   -----------------
   -- Identity_Of --
   -----------------

   function Identity_Of (F : Frame) return Word is
      Bits   : constant Word := Word (F.Id);
      Result : Image;
   begin
      pragma Assert (Bits <= 16#1FFF_FFFF#);
      pragma Assert (if F.Format = Can.Standard then Bits <= 16#7FF#);
      if F.Format = Extended then
         Result.Identity :=
           (Interfaces.Shift_Left (Bits, 3) and 16#FFE0_0000#)
           or (Interfaces.Shift_Left (Bits, 1) and 16#7_FFFE#)
           or Remote_Standard
           or Extended_Bit
           or (if F.Kind = Remote then Remote_Extended else 0);
      else
         Result.Identity :=
           Interfaces.Shift_Left (Bits, 21)
           or (if F.Kind = Remote then Remote_Standard else 0);
      end if;
      pragma Assert (Bits_Of (Result.Identity) = Bits);
      pragma Assert (Identifier (Bits) = F.Id);
      pragma Assert (Id_Of (Result) = Identifier (Bits_Of (Result.Identity)));
      pragma Assert (Id_Of (Result) = F.Id);
      return Result.Identity;
   end Identity_Of;

   --------------
   -- Image_Of --
   --------------

   function Image_Of (F : Frame) return Image is
      Bits : constant Interfaces.Unsigned_64 := Payload (F);
   begin
      return
        (Identity  => Identity_Of (F),
         Layout    => Interfaces.Shift_Left (Word (F.Length), 28),
         Data_Low  => Swapped (Word (Bits and 16#FFFF_FFFF#)),
         Data_High => Swapped (Word (Interfaces.Shift_Right (Bits, 32))));
   end Image_Of;

end Ravenchart.Can.Xcan_Frames;
