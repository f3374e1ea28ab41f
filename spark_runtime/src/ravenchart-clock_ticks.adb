package body Ravenchart.Clock_Ticks
  with SPARK_Mode
is

   --------------
   -- To_Ticks --
   --------------

   function To_Ticks (Length : Nanoseconds) return Tick_Span is
      Seconds : constant Nanoseconds := Length / Per_Second;
      Rest    : constant Product     := Product (Length mod Per_Second);
   begin
      return
        (Minutes => Minute_Count (Seconds / 60),
         Seconds => Second_Count (Seconds mod 60),
         Ticks   => Tick_Count (Ceiling (Rest * Rate, Per_Second)));
   end To_Ticks;

   --------------------
   -- To_Nanoseconds --
   --------------------

   function To_Nanoseconds (Span : Tick_Span) return Nanoseconds is
      Seconds : constant Product := Product (Whole_Seconds (Span));
      Rest    : constant Product :=
        Ceiling (Product (Span.Ticks) * Per_Second, Rate);
   begin
      return Nanoseconds
        (Product'Min
           (Seconds * Per_Second + Rest, Product (Nanoseconds'Last)));
   end To_Nanoseconds;

   ----------------------------------
   -- Lemma_Late_By_A_Tick_At_Most --
   ----------------------------------

   procedure Lemma_Late_By_A_Tick_At_Most (Length : Nanoseconds) is null;

   --------------------------
   -- Lemma_Whole_Is_Exact --
   --------------------------

   procedure Lemma_Whole_Is_Exact (Length : Nanoseconds) is null;

   --------------------
   -- Lemma_No_Drift --
   --------------------

   procedure Lemma_No_Drift
     (Offset  : Nanoseconds;
      Period  : Positive_Nanoseconds;
      Release : Event_Count) is
   begin
      Lemma_Whole_Is_Exact (Schedules.Due (Offset, Period, Release));
   end Lemma_No_Drift;

end Ravenchart.Clock_Ticks;
