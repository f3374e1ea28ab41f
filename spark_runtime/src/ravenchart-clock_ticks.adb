--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Clock_Ticks
  with SPARK_Mode
is

   ----------------------------------
   -- Lemma_Late_By_A_Tick_At_Most --
   ----------------------------------

   procedure Lemma_Late_By_A_Tick_At_Most (Length : Nanoseconds) is
      Rest  : constant Product := Product (Length mod Per_Second);
      Ticks : constant Product := Ceiling (Rest * Rate, Per_Second);
      Later : constant Product := Ceiling (Ticks * Per_Second, Rate);
   begin
      pragma Assert (Later * Rate >= Rest * Rate);
      pragma Assert (Later >= Rest);
      pragma Assert (Later * Rate < Rest * Rate + Per_Second + Rate);
      pragma Assert (Product (Tick_Length) * Rate >= Per_Second);
      pragma Assert (Later - Rest <= Product (Tick_Length));
   end Lemma_Late_By_A_Tick_At_Most;

   --------------------------
   -- Lemma_Whole_Is_Exact --
   --------------------------

   procedure Lemma_Whole_Is_Exact (Length : Nanoseconds) is
      Rest  : constant Product := Product (Length mod Per_Second);
      Ticks : constant Product := Ceiling (Rest * Rate, Per_Second);
      Later : constant Product := Ceiling (Ticks * Per_Second, Rate);
   begin
      pragma Assert (Ticks * Per_Second = Rest * Rate);
      pragma Assert (Later = Rest);
   end Lemma_Whole_Is_Exact;

   ------------------------
   -- Lemma_Sum_Is_Whole --
   ------------------------

   procedure Lemma_Sum_Is_Whole (Left, Right : Nanoseconds) is
      First  : constant Product := Product (Left mod Per_Second);
      Second : constant Product := Product (Right mod Per_Second);
      Rest   : constant Product :=
        (if First + Second < Per_Second
         then First + Second
         else First + Second - Per_Second);
   begin
      pragma Assert (Product ((Left + Right) mod Per_Second) = Rest);
      pragma Assert (First * Rate = First * Rate / Per_Second * Per_Second);
      pragma Assert (Second * Rate = Second * Rate / Per_Second * Per_Second);
   end Lemma_Sum_Is_Whole;

   --------------------
   -- Lemma_No_Drift --
   --------------------

   procedure Lemma_No_Drift
     (Offset  : Nanoseconds;
      Period  : Positive_Nanoseconds;
      Release : Event_Count) is
   begin
      for Later in 1 .. Release loop
         pragma Assert
           (Schedules.Due (Offset, Period, Later)
            - Schedules.Due (Offset, Period, Later - 1)
            = Period);
         Lemma_Sum_Is_Whole
           (Schedules.Due (Offset, Period, Later - 1), Period);
         pragma Loop_Invariant
           (Is_Whole (Schedules.Due (Offset, Period, Later)));
      end loop;
      Lemma_Whole_Is_Exact (Schedules.Due (Offset, Period, Release));
   end Lemma_No_Drift;

end Ravenchart.Clock_Ticks;
