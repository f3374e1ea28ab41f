--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Layout_Lemmas
  with SPARK_Mode
is

   procedure Lemma_Mask (S : Signal; Ones : Unsigned_64) is null;

   procedure Lemma_Intel_Within
     (Words : Fd_Frames.Fd_Words;
      S     : Signal;
      Word  : Fd_Frames.Word_Index;
      Shift : Bit_Shift)
   is null;

   procedure Lemma_Intel_Over
     (Words : Fd_Frames.Fd_Words;
      S     : Signal;
      Word  : Fd_Frames.Word_Index;
      Shift : Bit_Shift)
   is
   begin
      pragma Assert
        (Joined (Words, S)
         = (Shift_Right (Words (Word), Shift)
            or Shift_Left (Words (Word + 1), 64 - Shift)));
      pragma Assert
        (Raw (Words, S) = (Joined (Words, S) and Layouts.Mask (S.Width)));
   end Lemma_Intel_Over;

   procedure Lemma_Motorola_Within
     (Words : Fd_Frames.Fd_Words;
      S     : Signal;
      Word  : Fd_Frames.Word_Index;
      Shift : Bit_Shift)
   is null;

   procedure Lemma_Motorola_Over
     (Words : Fd_Frames.Fd_Words;
      S     : Signal;
      Word  : Fd_Frames.Word_Index;
      Shift : Bit_Shift)
   is
   begin
      pragma Assert
        (Joined (Words, S)
         = (Shift_Left (Reversed (Words (Word)), Shift)
            or Shift_Right (Reversed (Words (Word + 1)), 64 - Shift)));
      pragma Assert
        (Raw (Words, S) = (Joined (Words, S) and Layouts.Mask (S.Width)));
   end Lemma_Motorola_Over;

end Ravenchart.Can.Layout_Lemmas;
