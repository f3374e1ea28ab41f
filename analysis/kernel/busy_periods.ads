--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Busy periods of plain tasks under fixed priorities, compiled for the
--  analysis of large sets. Plain: one WCET, no jitter.
--
--  Guarantees   a busy period that is found is long enough for all releases in
--               it at its level; tests show that it is the least. Every
--               operation is total, none overflows
--  Tasking      none: a value from values
--  Timing       at most Most_Rounds passes over the tasks of each level
--
--  Joseph and Pandya, Finding response times in a real-time system (The
--  Computer Journal 29, 1986). The releases of a task are counted again only
--  when the window passes the next of them. The window of a level continues
--  from that of the level before (Sjodin and Hansson, RTSS 1998).

with Interfaces.C;

package Busy_Periods
  with SPARK_Mode, Pure
is
   use type Interfaces.C.int;

   Most_Tasks : constant := 2**13;

   Limit : constant := 2**47;
   --  Times from here on are rejected.

   Most_Rounds : constant := 200;
   --  A window that still grows after so many rounds is given up.

   type Ticks is range 0 .. 2**62
   with Size => 64;
   --  A time in the unit of the task set.

   subtype Task_Count is Interfaces.C.int range 0 .. Most_Tasks;

   subtype Task_Number is Task_Count range 1 .. Most_Tasks;
   --  Tasks come most urgent first.

   type Times is array (Task_Number) of Ticks
   with Convention => C;
   --  One for each task; those behind the last task are ignored.

   type Levels is array (Task_Number) of Interfaces.C.int
   with Convention => C;
   --  The last task that is as urgent as each.

   function Are_Plain
     (Count        : Task_Count;
      Period, Wcet : Times) return Boolean
   is (for all J in 1 .. Count =>
         Period (J) < Limit and then Wcet (J) in 1 .. Period (J))
   with Ghost;
   --  Every task alone fits its core.

   function Executed
     (Period, Wcet : Times;
      J            : Task_Number;
      Window       : Ticks) return Ticks
   is (((Window - 1) / Period (J) + 1) * Wcet (J))
   with
     Ghost,
     Pre  =>
       Window in 1 .. Limit
       and then Period (J) < Limit
       and then Wcet (J) in 1 .. Period (J),
     Post => Executed'Result <= 2 * Limit;
   --  The execution of the releases of task J within a window, the first of
   --  them at its beginning.

   function Demand
     (Period, Wcet : Times;
      Level        : Task_Count;
      Window       : Ticks) return Ticks
   is (if Level = 0 then 0
       else Demand (Period, Wcet, Level - 1, Window)
            + Executed (Period, Wcet, Level, Window))
   with
     Ghost,
     Subprogram_Variant => (Decreases => Level),
     Pre  =>
       Window in 1 .. Limit and then Are_Plain (Level, Period, Wcet),
     Post => Demand'Result <= Ticks (Level) * (2 * Limit);
   --  The same of the tasks up to Level together.

   procedure Find
     (Count        : Task_Count;
      Period, Wcet : Times;
      Last         : Levels;
      Blocked      : Times;
      Found        : in out Times)
   with
     Export,
     Convention    => C,
     External_Name => "find_busy_periods",
     Pre  =>
       Are_Plain (Count, Period, Wcet)
       and then (for all J in 1 .. Count =>
                   Last (J) in J .. Count and then Blocked (J) < Limit),
     Post =>
       (for all J in 1 .. Count =>
          Found (J) = 0
          or else
            (Found (J) in 1 .. Period (J)
             and then Blocked (J)
                      + Demand (Period, Wcet, Last (J), Found (J))
                      <= Found (J)));
   --  The busy period at the level of each task, which begins with a section
   --  of a less urgent task of length Blocked. It is 0 where it is longer than
   --  the task's period, may have no end, or is given up.

end Busy_Periods;
