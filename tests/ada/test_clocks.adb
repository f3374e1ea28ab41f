--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Lengths of time in ticks, for clocks whose tick is 1 ns, 10 ns and no
--  whole number of nanoseconds; and in those of the clock of this machine.

with Ada.Real_Time;
with Facts;
with Ravenchart.Clock_Ticks;
with Ravenchart.Epochs;
with Ravenchart.Schedules;

procedure Test_Clocks is
   use type Ada.Real_Time.Time;
   use type Ada.Real_Time.Time_Span;
   use type Ravenchart.Event_Count;
   use type Ravenchart.Nanoseconds;

   package Of_1_Ns is new Ravenchart.Clock_Ticks (1_000_000_000);
   package Of_10_Ns is new Ravenchart.Clock_Ticks (100_000_000);
   package Of_168_Mhz is new Ravenchart.Clock_Ticks (168_000_000);
   package Of_333_Mhz is new Ravenchart.Clock_Ticks (333_333_343);

   type Sample_Array is array (Positive range <>) of Ravenchart.Nanoseconds;

   Samples : constant Sample_Array :=
     (0, 1, 9, 10, 11, 999, 1_000, 1_005, 999_999_999, 1_000_000_000,
      2_147_483_648, 60_000_000_000, 3_600_000_000_001,
      2**61 + 12_345_678_901, 2**62 - 2, 2**62 - 1);

   generic
      Clock : String;
      with package Ticks is new Ravenchart.Clock_Ticks (<>);
   procedure Check_Rounding;

   procedure Check_Releases;

   procedure Check_Figures;

   procedure Check_This_Clock;

   --------------------
   -- Check_Rounding --
   --------------------

   procedure Check_Rounding is
      Later   : Ravenchart.Nanoseconds;
      Up      : Boolean := True;
      Exact   : Boolean := True;
      Covered : Boolean := True;
      Span    : Ticks.Tick_Span;
   begin
      for Length of Samples loop
         Span  := Ticks.To_Ticks (Length);
         Later := Ticks.To_Nanoseconds (Span);
         Up    := Up and then Later >= Length
           and then Later - Length <= Ticks.Tick_Length;
         Exact := Exact
           and then (if Ticks.Is_Whole (Length) then Later = Length);
         if Span.Ticks > 0 then
            Span.Ticks := Span.Ticks - 1;
            Covered    := Covered
              and then (Ticks.To_Nanoseconds (Span) <= Length);
         end if;
      end loop;
      Facts.Check (Clock & ": late by a tick at most, and never early", Up);
      Facts.Check (Clock & ": whole numbers of ticks are exact", Exact);
      Facts.Check (Clock & ": one tick less is too short", Covered);
   end Check_Rounding;

   --------------------
   -- Check_Releases --
   --------------------

   procedure Check_Releases is
      use type Of_10_Ns.Tick_Span;
      use type Of_333_Mhz.Tick_Span;
      Millisecond : constant := 1_000_000;
      Near        : Of_333_Mhz.Tick_Span;
      Odd         : Of_10_Ns.Tick_Span;
      Due         : Ravenchart.Nanoseconds;
      Drift       : Boolean := False;
   begin
      for Release in Ravenchart.Event_Count range 0 .. 100_000 loop
         Due   := Ravenchart.Schedules.Due (0, Millisecond, Release);
         Near  := Of_333_Mhz.To_Ticks (Due);
         Drift := Drift
           or else Of_333_Mhz.To_Nanoseconds (Near)
             not in Due .. Due + Of_333_Mhz.Tick_Length;
      end loop;
      Facts.Check ("a period of 333333.343 ticks does not drift", not Drift);
      Facts.Check
        ("its release 100000 is due in the first tick of a second",
         Near = (Minutes => 1, Seconds => 40, Ticks => 0));
      Odd := Of_10_Ns.To_Ticks
        (Ravenchart.Schedules.Due (5, 1_005, 1_000_001));
      Facts.Check
        ("a period of 100.5 ticks does not drift",
         Odd = (Minutes => 0, Seconds => 1, Ticks => 500_101));
      Facts.Check
        ("the last release is due in range",
         Ravenchart.Schedules.Due
           (7, 10, Ravenchart.Schedules.Last_Release (7, 10))
         > Ravenchart.Nanoseconds'Last - 10);
   end Check_Releases;

   -------------------
   -- Check_Figures --
   -------------------

   procedure Check_Figures is
   begin
      Facts.Check
        ("1005 ns are 101 ticks of 10 ns",
         Of_10_Ns.To_Ticks (1_005).Ticks = 101
         and then not Of_10_Ns.Is_Whole (1_005)
         and then Of_10_Ns.Is_Whole (1_010));
      Facts.Check
        ("101 ticks of 10 ns are 1010 ns",
         Of_10_Ns.To_Nanoseconds ((0, 0, 101)) = 1_010);
      Facts.Check
        ("125 ns are 21 ticks of 168 MHz, 126 ns are 22",
         Of_168_Mhz.To_Ticks (125).Ticks = 21
         and then Of_168_Mhz.To_Ticks (126).Ticks = 22
         and then Of_168_Mhz.Is_Whole (125)
         and then not Of_168_Mhz.Is_Whole (126));
      Facts.Check
        ("22 ticks of 168 MHz are 131 ns",
         Of_168_Mhz.To_Nanoseconds ((0, 0, 22)) = 131
         and then Of_168_Mhz.Tick_Length = 6);
      Facts.Check
        ("a span that is too long saturates",
         Of_10_Ns.To_Nanoseconds
           ((Minutes => Of_10_Ns.Minute_Count'Last,
             Seconds => Of_10_Ns.Second_Count'Last,
             Ticks   => Of_10_Ns.Tick_Count'Last))
         = Ravenchart.Nanoseconds'Last);
   end Check_Figures;

   ----------------------
   -- Check_This_Clock --
   ----------------------

   procedure Check_This_Clock is
      Same : Boolean := True;
   begin
      for Length of Samples loop
         Same := Same
           and then Ravenchart.Epochs.To_Nanoseconds
             (Ravenchart.Epochs.To_Span (Length)) = Length;
      end loop;
      Facts.Check ("durations survive the way to spans and back", Same);
      Facts.Check
        ("3 s are a span of 3 s",
         Ravenchart.Epochs.To_Span (3_000_000_000)
         = Ada.Real_Time.Seconds (3));
      Facts.Check
        ("an instant counts from the start",
         Ravenchart.Epochs.Instant (61_000_000_007)
         = Ravenchart.Epochs.Start + Ada.Real_Time.Seconds (61)
           + Ada.Real_Time.Nanoseconds (7));
      Facts.Check
        ("a negative span is 0 ns",
         Ravenchart.Epochs.To_Nanoseconds (Ada.Real_Time.Nanoseconds (-1))
         = 0);
      Facts.Check
        ("the longest span is the longest duration",
         Ravenchart.Epochs.To_Nanoseconds (Ada.Real_Time.Time_Span_Last)
         = Ravenchart.Nanoseconds'Last);
   end Check_This_Clock;

   procedure Check_1_Ns is new Check_Rounding ("1 ns", Of_1_Ns);
   procedure Check_10_Ns is new Check_Rounding ("10 ns", Of_10_Ns);
   procedure Check_168_Mhz is new Check_Rounding ("168 MHz", Of_168_Mhz);
   procedure Check_333_Mhz is new Check_Rounding ("333 MHz", Of_333_Mhz);

begin
   Check_1_Ns;
   Check_10_Ns;
   Check_168_Mhz;
   Check_333_Mhz;
   Check_Releases;
   Check_Figures;
   Check_This_Clock;
   Facts.Finish;
end Test_Clocks;
