--  The table of a processor: which activity runs in which release.
--
--  Guarantees   no state
--  Tasking      none
--  Timing       constant

package Ravenchart.Schedules
  with SPARK_Mode, Pure
is

   type Slot is record
      Divisor : Positive := 1;
      Phase   : Natural := 0;
   end record;
   --  One activity: its period is Divisor periods of the processor.

   function Runs_In (S : Slot; Release : Natural) return Boolean
   is (Release mod S.Divisor = S.Phase)
   with Global => null;
   --  Does the activity of S run in this release?

   function Fits (S : Slot; Cycle : Positive) return Boolean
   is (S.Phase < S.Divisor and then Cycle mod S.Divisor = 0)
   with Global => null;
   --  Does S run, and does its pattern repeat with the Cycle?

end Ravenchart.Schedules;
