--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Ctu_Frames
  with SPARK_Mode
is
   function Identity_Of (Id : Identifier; Format : Frame_Format) return Word
   with
     Pre  => Fits (Id, Format),
     Post => Bits_Of (Identity_Of'Result, Format) = Word (Id);
   --  IDENTIFIER_W.

   procedure Lemma_Kept (Bits : Word; Id : Identifier)
   with
     Ghost,
     Global => null,
     Pre    => Bits = Word (Id),
     Post   => Bits <= Word (Identifier'Last) and then Identifier (Bits) = Id;
   --  An identifier is the same after both conversions. Provers do not find
   --  that for the result of a function.

   function Rest_Of (Length : Fd_Frames.Fd_Length) return Word
   is (Interfaces.Shift_Left (Word (3 + (Length + 3) / 4), 11))
   with
     Post => Words (Rest_Of'Result) = 4 + (Length + 3) / 4
       and then (Rest_Of'Result and 16#FFFF_07FF#) = 0;
   --  RWCNT of a frame with so many bytes.

   function Packed (F : Fd_Frames.Fd_Frame; At_Word : Data_Word) return Word
   is (Word (Fd_Frames.Byte (F, 4 * At_Word))
       or Interfaces.Shift_Left
            (Word (Fd_Frames.Byte (F, 4 * At_Word + 1)), 8)
       or Interfaces.Shift_Left
            (Word (Fd_Frames.Byte (F, 4 * At_Word + 2)), 16)
       or Interfaces.Shift_Left
            (Word (Fd_Frames.Byte (F, 4 * At_Word + 3)), 24));
   --  Four bytes, the first one lowest.

   ----------------
   -- Lemma_Kept --
   ----------------

   procedure Lemma_Kept (Bits : Word; Id : Identifier) is
   begin
      pragma Assert (Identifier (Word (Id)) = Id and then Bits = Word (Id));
   end Lemma_Kept;

   -----------------
   -- Identity_Of --
   -----------------

   function Identity_Of (Id : Identifier; Format : Frame_Format) return Word
   is
      Bits : constant Word := Word (Id);
   begin
      pragma Assert (Bits <= 16#1FFF_FFFF#);
      pragma Assert (if Format = Can.Standard then Bits <= 16#7FF#);
      return
        (if Format = Extended
         then Bits
         else Interfaces.Shift_Left (Bits, 18));
   end Identity_Of;

   --------------
   -- Frame_Of --
   --------------

   function Frame_Of (I : Image) return Frame is
      Kind   : constant Frame_Kind :=
        (if (I.Layout and Remote_Bit) /= 0 then Remote else Data);
      Length : constant Data_Length :=
        Natural'Min (8, Natural (Code_Of (I)));
      Bits   : constant Interfaces.Unsigned_64 :=
        Interfaces.Unsigned_64 (I.Data (0))
        or Interfaces.Shift_Left (Interfaces.Unsigned_64 (I.Data (1)), 32);
   begin
      return
        (Id     => Id_Of (I),
         Format => Format_Of (I),
         Kind   => Kind,
         Length => Length,
         Bits   => (if Kind = Remote then 0 else Bits and Mask (Length)));
   end Frame_Of;

   --------------
   -- Image_Of --
   --------------

   function Image_Of (F : Frame) return Image is
      Bits   : constant Interfaces.Unsigned_64 := Payload (F);
      Layout : Word :=
        Rest_Of (if F.Kind = Remote then 0 else F.Length) or Word (F.Length);
      Result : Image;
   begin
      if F.Format = Extended then
         Layout := Layout or Extended_Bit;
      end if;
      if F.Kind = Remote then
         Layout := Layout or Remote_Bit;
      end if;
      Result.Layout   := Layout;
      Result.Identity := Identity_Of (F.Id, F.Format);
      Result.Data (0) := Word (Bits and 16#FFFF_FFFF#);
      Result.Data (1) := Word (Interfaces.Shift_Right (Bits, 32));
      Lemma_Kept (Bits_Of (Result.Identity, Format_Of (Result)), F.Id);
      pragma Assert (Id_Of (Result) = F.Id);
      pragma Assert (Frame_Of (Result).Id = F.Id);
      return Result;
   end Image_Of;

   -----------------
   -- Fd_Frame_Of --
   -----------------

   function Fd_Frame_Of (I : Image) return Fd_Frames.Fd_Frame is
      Bytes : Fd_Frames.Fd_Bytes := (others => 0);
   begin
      for B in Fd_Frames.Fd_Index loop
         Bytes (B) := Data_Byte (I, B);
         pragma Loop_Invariant
           (for all C in 0 .. B => Bytes (C) = Data_Byte (I, C));
      end loop;
      return
        Fd_Frames.Fd_Data_Frame
          (Id     => Id_Of (I),
           Format => Format_Of (I),
           Length => Fd_Frames.Length_Of (Code_Of (I)),
           Bytes  => Bytes,
           Rate   =>
             (if (I.Layout and Switch_Bit) /= 0
              then Fd_Frames.Switched_Rate
              else Fd_Frames.Constant_Rate),
           Sender =>
             (if (I.Layout and Passive_Bit) /= 0
              then Fd_Frames.Passive_Sender
              else Fd_Frames.Active_Sender));
   end Fd_Frame_Of;

   --------------
   -- Image_Of --
   --------------

   function Image_Of (F : Fd_Frames.Fd_Frame) return Image is
      Layout : Word :=
        Rest_Of (F.Length) or Fd_Bit
        or Word (Fd_Frames.Code (F.Length));
      Result : Image;
   begin
      if F.Format = Extended then
         Layout := Layout or Extended_Bit;
      end if;
      if F.Rate = Fd_Frames.Switched_Rate then
         Layout := Layout or Switch_Bit;
      end if;
      if F.Sender = Fd_Frames.Passive_Sender then
         Layout := Layout or Passive_Bit;
      end if;
      Result.Layout   := Layout;
      Result.Identity := Identity_Of (F.Id, F.Format);
      for W in Data_Word loop
         Result.Data (W) := Packed (F, W);
         pragma Loop_Invariant
           (for all V in 0 .. W => Result.Data (V) = Packed (F, V));
      end loop;
      Lemma_Kept (Bits_Of (Result.Identity, Format_Of (Result)), F.Id);
      pragma Assert (Id_Of (Result) = F.Id);
      pragma Assert (Fd_Frame_Of (Result).Id = F.Id);
      return Result;
   end Image_Of;

end Ravenchart.Can.Ctu_Frames;
