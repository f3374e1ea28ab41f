--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The instants of rows that count by their releases and not by a clock: the
--  release of an execution, and the end of its logical execution time (T. A.
--  Henzinger, B. Horowitz, C. M. Kirsch, Giotto: a time-triggered language for
--  embedded programming, Proceedings of the IEEE 91, 2003).
--
--  Guarantees   no state
--  Tasking      none
--  Timing       constant

package Ravenchart.Logical_Times
  with SPARK_Mode, Pure
is
   function Later
     (Instant : Nanoseconds; Period : Positive_Nanoseconds) return Nanoseconds
   is (if Instant > Nanoseconds'Last - Period then Nanoseconds'Last
       else Instant + Period)
   with Global => null;
   --  The instant of the next execution of a row: each one has its release, as
   --  none is dropped or merged.

end Ravenchart.Logical_Times;
