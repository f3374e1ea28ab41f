--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Words that all queues share, whatever they hold.
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
   --  What a full queue gives up when one more element comes.

   type Put_Status is (Queued, Rejected_Full, Dropped_Oldest);
   --  Dropped_Oldest says that the element was queued in another's place.

   type Take_Status is (Taken, Empty);
   --  Whether there was an element to take.

end Ravenchart.Queueing;
