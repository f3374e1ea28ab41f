--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Sums of the response-time analysis, as timing certificates state them:
--  static functions, which the compiler evaluates.
--
--  Guarantees   nothing overflows: a sum beyond Time is Time'Last, and so
--               longer than any Window
--  Tasking      none
--  Timing       none at run time
--  Analysis     releases in a window: Joseph and Pandya 1986, with release
--               jitter as in Tindell, Burns and Wellings 1994

pragma Ada_2022;

package Ravenchart.Response_Times
  with SPARK_Mode, Pure
is

   subtype Time is Long_Long_Integer range 0 .. 2 ** 62 - 1;
   --  In nanoseconds.

   subtype Window is Time range 0 .. 2 ** 60 - 1;
   --  A time from the start of a busy period on, or a lateness.

   subtype Separation is Window range 1 .. Window'Last;
   --  A period, or the least time between two releases.

   function Sum (Left, Right : Time) return Time
   is (if Left <= Time'Last - Right then Left + Right else Time'Last)
   with Static;

   function Product (Count, C : Time) return Time
   is (if C = 0 or else Count <= Time'Last / C
       then Count * C
       else Time'Last)
   with Static;

   function Releases (W, J : Window; T : Separation) return Time
   is ((W + J + (T - 1)) / T)
   with Static;
   --  The most releases within W, T apart and each up to J late.

   function Demand
     (W, J : Window; T : Separation; C : Window) return Time
   is (Product (Releases (W, J, T), C))
   with Static;
   --  The time that these releases execute, each C.

   function Demand
     (W, J : Window; T : Separation; C : Window; More : Time) return Time
   is (Sum (Demand (W, J, T, C), More))
   with Static;
   --  The same, plus More.

end Ravenchart.Response_Times;
