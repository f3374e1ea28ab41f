--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Types that all queues share.
--
--  Guarantees   no state
--  Tasking      none
--  Timing       none

package Ravenchart.Queueing
  with SPARK_Mode, Pure
is

   subtype Length_Type is Natural range 0 .. 65_536;
   --  Elements in a queue; large enough for a trace, small enough to index.

   subtype Capacity_Type is Length_Type range 1 .. Length_Type'Last;
   --  Room in a queue.

   type Fill is record
      Now     : Length_Type := 0;
      Highest : Length_Type := 0;
   end record;
   --  How many elements wait, and the most that ever waited.

   type Overflow_Policy is (Reject_Newest, Drop_Oldest);
   --  The element that a full queue gives up when one more element comes.

   type Put_Status is (Queued, Rejected_Full, Dropped_Oldest);
   --  Dropped_Oldest: the element was queued in place of the oldest one.

   type Take_Status is (Taken, Empty);
   --  Was there an element to take?

end Ravenchart.Queueing;
