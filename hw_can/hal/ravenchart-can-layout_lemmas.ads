--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The bits of a signal of a longer frame, by the words that hold them. The
--  lemmas are proved here for all rows, so that only the numbers of one row
--  are left to compute.
--
--  Guarantees   by proof; no code here is executed
--  Tasking      none
--  Timing       none

with Interfaces;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Layouts;

package Ravenchart.Can.Layout_Lemmas
  with SPARK_Mode, Pure, Ghost
is
   use Interfaces;
   use Ravenchart.Can.Layouts;

   subtype Bit_Shift is Natural range 0 .. 63;

   procedure Lemma_Mask (S : Signal; Ones : Unsigned_64)
   with
     Global => null,
     Pre    => Ones = Shift_Right (Unsigned_64'Last, 64 - S.Width),
     Post   => Layouts.Mask (S.Width) = Ones;
   --  The mask of a signal in numbers.

   procedure Lemma_Intel_Within
     (Words : Fd_Frames.Fd_Words;
      S     : Signal;
      Word  : Fd_Frames.Word_Index;
      Shift : Bit_Shift)
   with
     Global => null,
     Pre    =>
       S.Order = Intel
       and then Reaches_To (S) <= 512
       and then S.Start / 64 = Word
       and then (Reaches_To (S) - 1) / 64 = Word
       and then S.Start mod 64 = Shift,
     Post   =>
       Raw (Words, S)
       = (Shift_Right (Words (Word), Shift) and Layouts.Mask (S.Width));
   --  A signal in one word, from bit Shift of it on.

   procedure Lemma_Intel_Over
     (Words : Fd_Frames.Fd_Words;
      S     : Signal;
      Word  : Fd_Frames.Word_Index;
      Shift : Bit_Shift)
   with
     Global => null,
     Pre    =>
       S.Order = Intel
       and then Reaches_To (S) <= 512
       and then S.Start / 64 = Word
       and then Word < 7
       and then (Reaches_To (S) - 1) / 64 = Word + 1
       and then S.Start mod 64 = Shift,
     Post   =>
       Raw (Words, S)
       = ((Shift_Right (Words (Word), Shift)
           or Shift_Left (Words (Word + 1), 64 - Shift))
          and Layouts.Mask (S.Width));
   --  A signal that begins at bit Shift of one word and ends in the next.

   procedure Lemma_Motorola_Within
     (Words : Fd_Frames.Fd_Words;
      S     : Signal;
      Word  : Fd_Frames.Word_Index;
      Shift : Bit_Shift)
   with
     Global => null,
     Pre    =>
       S.Order = Motorola
       and then Reaches_To (S) <= 512
       and then S.Start / 64 = Word
       and then First_In_Order (S) / 64 = Word
       and then (Reaches_To (S) - 1) / 64 = Word
       and then 63 - (Reaches_To (S) - 1) mod 64 = Shift,
     Post   =>
       Raw (Words, S)
       = (Shift_Right (Reversed (Words (Word)), Shift)
          and Layouts.Mask (S.Width));
   --  A signal in one word, with Shift bits behind it.

   procedure Lemma_Motorola_Over
     (Words : Fd_Frames.Fd_Words;
      S     : Signal;
      Word  : Fd_Frames.Word_Index;
      Shift : Bit_Shift)
   with
     Global => null,
     Pre    =>
       S.Order = Motorola
       and then Reaches_To (S) <= 512
       and then First_In_Order (S) / 64 = Word
       and then Word < 7
       and then (Reaches_To (S) - 1) / 64 = Word + 1
       and then Reaches_To (S) mod 64 = Shift,
     Post   =>
       Raw (Words, S)
       = ((Shift_Left (Reversed (Words (Word)), Shift)
           or Shift_Right (Reversed (Words (Word + 1)), 64 - Shift))
          and Layouts.Mask (S.Width));
   --  A signal that begins in one word and has Shift bits in the next.

end Ravenchart.Can.Layout_Lemmas;
