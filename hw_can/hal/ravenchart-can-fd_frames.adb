--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Fd_Frames
  with SPARK_Mode
is
   function Is_Made (F : Fd_Frame; Words : Fd_Words) return Boolean
   is (for all I in Fd_Index =>
         Byte (F, I) = (if I < F.Length then Byte (Words, I) else 0))
   with Ghost;

   function Ends_Here
     (F : Fd_Frame; Words : Fd_Words; W : Word_Index) return Boolean
   is (Ends_Within (Words (W), F.Length - 8 * W))
   with Ghost;

   procedure Lemma_No_Byte
     (Word : Interfaces.Unsigned_64; Length : Integer; I : Byte_Index)
   with
     Ghost,
     Pre  => Ends_Within (Word, Length) and then I >= Length,
     Post => (Interfaces.Shift_Right (Word, 8 * I) and 16#FF#) = 0;
   --  A byte beyond the end of a word is 0.

   procedure Lemma_Same_Byte
     (F : Fd_Frame; Words : Fd_Words; W : Word_Index; I : Byte_Index)
   with
     Ghost,
     Pre  => Is_Made (F, Words) and then Ends_Here (F, Words, W),
     Post =>
       Interfaces.Unsigned_64 (Byte (F, 8 * W + I))
       = (Interfaces.Shift_Right (Words (W), 8 * I) and 16#FF#);
   --  A byte of the frame is that of the word, also beyond the length.

   procedure Lemma_Same_Word (F : Fd_Frame; Words : Fd_Words; W : Word_Index)
   with
     Ghost,
     Pre  => Is_Made (F, Words) and then Ends_Here (F, Words, W),
     Post => Word (F, W) = Words (W);
   --  Where the words end with the frame, all their bits are kept.

   -------------------
   -- Lemma_No_Byte --
   -------------------

   procedure Lemma_No_Byte
     (Word : Interfaces.Unsigned_64; Length : Integer; I : Byte_Index) is
   begin
      pragma Assert (Ends_Within (Word, Length) and then I >= Length);
   end Lemma_No_Byte;

   procedure Lemma_Same_Words (F : Fd_Frame; Words : Fd_Words)
   with
     Ghost,
     Pre  => Is_Made (F, Words),
     Post =>
       (if Ends_Within (Words, F.Length) then Fd_Frames.Words (F) = Words);
   --  The same for all words.

   ---------------------
   -- Lemma_Same_Byte --
   ---------------------

   procedure Lemma_Same_Byte
     (F : Fd_Frame; Words : Fd_Words; W : Word_Index; I : Byte_Index) is
   begin
      pragma Assert ((8 * W + I) / 8 = W);
      pragma Assert ((8 * W + I) mod 8 = I);
      if 8 * W + I >= F.Length then
         Lemma_No_Byte (Words (W), F.Length - 8 * W, I);
      end if;
   end Lemma_Same_Byte;

   ---------------------
   -- Lemma_Same_Word --
   ---------------------

   procedure Lemma_Same_Word (F : Fd_Frame; Words : Fd_Words; W : Word_Index)
   is
   begin
      Lemma_Same_Byte (F, Words, W, 0);
      Lemma_Same_Byte (F, Words, W, 1);
      Lemma_Same_Byte (F, Words, W, 2);
      Lemma_Same_Byte (F, Words, W, 3);
      Lemma_Same_Byte (F, Words, W, 4);
      Lemma_Same_Byte (F, Words, W, 5);
      Lemma_Same_Byte (F, Words, W, 6);
      Lemma_Same_Byte (F, Words, W, 7);
   end Lemma_Same_Word;

   ----------------------
   -- Lemma_Same_Words --
   ----------------------

   procedure Lemma_Same_Words (F : Fd_Frame; Words : Fd_Words) is
   begin
      if Ends_Within (Words, F.Length) then
         Lemma_Same_Word (F, Words, 0);
         Lemma_Same_Word (F, Words, 1);
         Lemma_Same_Word (F, Words, 2);
         Lemma_Same_Word (F, Words, 3);
         Lemma_Same_Word (F, Words, 4);
         Lemma_Same_Word (F, Words, 5);
         Lemma_Same_Word (F, Words, 6);
         Lemma_Same_Word (F, Words, 7);
      end if;
   end Lemma_Same_Words;

   -------------------
   -- Fd_Data_Frame --
   -------------------

   function Fd_Data_Frame
     (Id     : Identifier;
      Format : Frame_Format;
      Length : Fd_Length;
      Bytes  : Fd_Bytes;
      Rate   : Bit_Rate_Use := Switched_Rate;
      Sender : Sender_State := Active_Sender) return Fd_Frame
   is
      Kept : Fd_Bytes := (others => 0);
   begin
      for I in 0 .. Length - 1 loop
         Kept (I) := Bytes (I);
         pragma Loop_Invariant
           (for all J in Fd_Index =>
              Kept (J) = (if J <= I then Bytes (J) else 0));
      end loop;
      return
        (Id     => Id,
         Format => Format,
         Rate   => Rate,
         Sender => Sender,
         Length => Length,
         Bytes  => Kept);
   end Fd_Data_Frame;

   -------------------
   -- Fd_Data_Frame --
   -------------------

   function Fd_Data_Frame
     (Id     : Identifier;
      Format : Frame_Format;
      Length : Fd_Length;
      Words  : Fd_Words;
      Rate   : Bit_Rate_Use) return Fd_Frame
   is
      Kept : Fd_Bytes := (others => 0);
   begin
      for I in 0 .. Length - 1 loop
         Kept (I) := Byte (Words, I);
         pragma Loop_Invariant
           (for all J in Fd_Index =>
              Kept (J) = (if J <= I then Byte (Words, J) else 0));
      end loop;
      return Made : constant Fd_Frame :=
        (Id     => Id,
         Format => Format,
         Rate   => Rate,
         Sender => Active_Sender,
         Length => Length,
         Bytes  => Kept)
      do
         Lemma_Same_Words (Made, Words);
      end return;
   end Fd_Data_Frame;

   -----------
   -- Words --
   -----------

   function Words (F : Fd_Frame) return Fd_Words is
      Result : Fd_Words := (others => 0);
   begin
      for W in Word_Index loop
         Result (W) := Word (F, W);
         pragma Loop_Invariant
           (for all V in 0 .. W => Result (V) = Word (F, V));
      end loop;
      return Result;
   end Words;

end Ravenchart.Can.Fd_Frames;
