--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The mailbox of a sampled port whose sender has a logical execution time. A
--  value is visible from the end of that time on, whenever its computation is
--  over. So releases alone decide which value is taken.
--
--  Guarantees   Take hands over the newest value that is visible at Now, each
--               once (contract of Histories.Newest). No value that is visible
--               at Now is missed while Depth is the number of values that can
--               become visible after Now before Take is called, and one more
--  Tasking      one task puts, one task takes; neither ever waits
--  Timing       the time to copy Depth of Element_Type
--  Analysis     no shared object: no ceiling, no blocking
--  Assumptions  ASM-023, atomic objects order the accesses of two cores

with Ravenchart.Queueing;

generic
   type Element_Type is private;
   Null_Element : Element_Type;
   --  The element that Take returns when Empty.
   Depth : Positive;
   --  How many values are kept.
package Ravenchart.Logical_Samples
  with
    SPARK_Mode,
    Abstract_State =>
      (Kept, Seen,
       (State with Synchronous, External => (Async_Readers, Async_Writers))),
    Initializes    => (Kept, Seen, State)
is
   procedure Put (Item : Element_Type; Visible : Nanoseconds)
   with Global => (In_Out => (Kept, State));
   --  Show Item from the instant Visible on.

   procedure Take
     (Now    : Nanoseconds;
      Item   : out Element_Type;
      Status : out Queueing.Take_Status)
   with Global => (In_Out => (Seen, State));
   --  Hand over the newest value that is visible at Now, or Null_Element when
   --  there is none, or when that or a later one was taken before.

end Ravenchart.Logical_Samples;
