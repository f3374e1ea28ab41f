--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Lengths of time in ticks of a clock, for clocks of every rate: a tick need
--  not be a whole number of nanoseconds.
--
--  Guarantees   both conversions round up, exactly: an instant is the first
--               tick at or after the length. So no release is early and none
--               is late by a tick or more, at any distance from the start
--  Tasking      none
--  Timing       constant: one division by the rate or by a constant

with Ravenchart.Schedules;

generic
   Ticks_Per_Second : Positive;
package Ravenchart.Clock_Ticks
  with SPARK_Mode, Pure
is
   Per_Second : constant := 1_000_000_000;
   --  Nanoseconds in a second.

   type Product is range 0 .. 2**63 - 1;
   --  The product of a part of a second in one unit and the second in the
   --  other one.

   subtype Minute_Count is Natural range 0 .. (2**62 - 1) / (60 * Per_Second);
   subtype Second_Count is Natural range 0 .. 59;
   subtype Tick_Count is Natural range 0 .. Ticks_Per_Second;

   type Tick_Span is record
      Minutes : Minute_Count := 0;
      Seconds : Second_Count := 0;
      Ticks   : Tick_Count   := 0;
   end record;
   --  The sum of three parts. Each part fits the Integer by which
   --  Ada.Real_Time multiplies a span.

   function Rate return Product
   is (Product (Ticks_Per_Second))
   with Global => null;

   function Ceiling (Dividend, Divisor : Product) return Product
   is (Dividend / Divisor + (if Dividend mod Divisor = 0 then 0 else 1))
   with
     Global => null,
     Pre    => Divisor > 0 and then Dividend <= Product'Last - Divisor,
     Post   =>
       Ceiling'Result * Divisor in Dividend .. Dividend + Divisor - 1;
   --  The quotient, rounded up.

   function Tick_Length return Positive_Nanoseconds
   is (Positive_Nanoseconds (Ceiling (Per_Second, Rate)))
   with Global => null;
   --  The length of one tick, rounded up.

   function To_Ticks (Length : Nanoseconds) return Tick_Span
   is ((Minutes => Minute_Count (Length / Per_Second / 60),
        Seconds => Second_Count (Length / Per_Second mod 60),
        Ticks   => Tick_Count
          (Ceiling
             (Product (Length mod Per_Second) * Rate, Per_Second))))
   with Global => null;
   --  The shortest span that is not shorter than Length.

   function To_Nanoseconds (Span : Tick_Span) return Nanoseconds
   is (Nanoseconds
         (Product'Min
            ((Product (Span.Minutes) * 60 + Product (Span.Seconds))
             * Per_Second
             + Ceiling (Product (Span.Ticks) * Per_Second, Rate),
             Product (Nanoseconds'Last))))
   with Global => null;
   --  The shortest length that is not shorter than Span; the last value where
   --  Span is longer.

   function Is_Whole (Length : Nanoseconds) return Boolean
   is (Product (Length mod Per_Second) * Rate mod Per_Second = 0)
   with Global => null;
   --  Is Length a whole number of ticks?

   procedure Lemma_Late_By_A_Tick_At_Most (Length : Nanoseconds)
   with
     Ghost,
     Global => null,
     Post   =>
       To_Nanoseconds (To_Ticks (Length)) >= Length
       and then To_Nanoseconds (To_Ticks (Length)) - Length <= Tick_Length;
   --  An instant is never early, and is late by at most a tick.

   procedure Lemma_Whole_Is_Exact (Length : Nanoseconds)
   with
     Ghost,
     Global => null,
     Pre    => Is_Whole (Length),
     Post   => To_Nanoseconds (To_Ticks (Length)) = Length;
   --  Both conversions keep a whole number of ticks exactly.

   procedure Lemma_Sum_Is_Whole (Left, Right : Nanoseconds)
   with
     Ghost,
     Global => null,
     Pre    =>
       Is_Whole (Left)
       and then Is_Whole (Right)
       and then Left <= Nanoseconds'Last - Right,
     Post   => Is_Whole (Left + Right);
   --  The sum of two whole numbers of ticks is one.

   procedure Lemma_No_Drift
     (Offset  : Nanoseconds;
      Period  : Positive_Nanoseconds;
      Release : Event_Count)
   with
     Ghost,
     Global => null,
     Pre    =>
       Release <= Schedules.Last_Release (Offset, Period)
       and then Is_Whole (Offset)
       and then Is_Whole (Period),
     Post   =>
       To_Nanoseconds (To_Ticks (Schedules.Due (Offset, Period, Release)))
       = Schedules.Due (Offset, Period, Release);
   --  Where offset and period are whole, each release is exact.

end Ravenchart.Clock_Ticks;
