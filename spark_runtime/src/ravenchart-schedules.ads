--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The table of a processor: the instant at which each release is due, and the
--  activities that run in it.
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

   function Last_Release
     (Offset : Nanoseconds; Period : Positive_Nanoseconds) return Event_Count
   is (Event_Count ((Nanoseconds'Last - Offset) / Period))
   with Global => null;
   --  The last release that is due within the range of Nanoseconds.

   function Due
     (Offset  : Nanoseconds;
      Period  : Positive_Nanoseconds;
      Release : Event_Count)
      return Nanoseconds
   is (Offset + Nanoseconds (Release) * Period)
   with
     Global => null,
     Pre    => Release <= Last_Release (Offset, Period);
   --  The instant at which the release is due, from Epochs.Start: no release
   --  depends on the one before.

end Ravenchart.Schedules;
