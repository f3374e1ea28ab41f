--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The common time origin of all processors, and conversions of durations to
--  and from the real-time clock.
--
--  Guarantees   Start is set once, before any task runs. It lies a margin
--               ahead, so that all processors begin together
--  Tasking      any task may call; nothing here blocks
--  Timing       constant; Since_Start reads the clock once
--  Assumptions  ASM-003, the clock stays within the range of Time

with Ada.Real_Time;

package Ravenchart.Epochs
  with
    SPARK_Mode,
    Elaborate_Body,
    Initializes => (Start => Ada.Real_Time.Clock_Time)
is
   use type Ada.Real_Time.Time;

   Start_Margin : constant Positive_Nanoseconds := 200_000_000;
   --  From elaboration to Start; sufficient to activate all tasks.

   Start : Ada.Real_Time.Time
   with Constant_After_Elaboration;
   --  The instant at which release 0 of a processor without offset is due.

   function To_Span (Length : Nanoseconds) return Ada.Real_Time.Time_Span
   with Global => null;
   --  Length as a span, rounded up to a tick of the clock, also beyond the 2.1
   --  s that GNAT's own conversion of nanoseconds can take.

   function To_Nanoseconds
     (Span : Ada.Real_Time.Time_Span) return Nanoseconds
   with Global => null;
   --  Span in nanoseconds, rounded up; 0 when negative, the last value when
   --  too long.

   function Instant (Elapsed : Nanoseconds) return Ada.Real_Time.Time
   with Global => Start;
   --  The first tick of the clock at or after Elapsed from Start. Rounding
   --  errors do not accumulate from one instant to the next.

   procedure Since_Start (Elapsed : out Nanoseconds)
   with
     Global => (Input => (Start, Ada.Real_Time.Clock_Time));
   --  Time since Start, and 0 before it.

end Ravenchart.Epochs;
