--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The places of a queue, without its elements: the place for the next
--  element, that of the oldest one, and the one that a full queue gives up.
--  Proved once here, so that each instance of a queue has little left to
--  prove.
--
--  Guarantees   the places in use are distinct and keep the order of arrival;
--               each loss is counted once; every operation is total
--  Tasking      none of its own: the queue owns its Ring
--  Timing       constant

with Ravenchart.Queueing;

package Ravenchart.Rings
  with SPARK_Mode, Pure
is
   pragma Assertion_Policy (Post => Ignore, Contract_Cases => Ignore);
   --  Proved, never executed: to check a Post takes time linear in the length.

   subtype Length_Type is Queueing.Length_Type;
   subtype Capacity_Type is Queueing.Capacity_Type;

   use type Queueing.Overflow_Policy;
   use type Queueing.Put_Status;
   use type Queueing.Take_Status;

   type Ring (Capacity : Capacity_Type) is private
   with
     Default_Initial_Condition =>
       Length (Ring) = 0
       and then Highest (Ring) = 0
       and then Lost (Ring) = 0;
   --  Places 1 .. Capacity, of which some are in use.

   function Length (R : Ring) return Length_Type
   with
     Global => null,
     Post   => Length'Result <= Highest (R);
   --  How many places are in use.

   function Highest (R : Ring) return Length_Type
   with
     Global => null,
     Post   => Highest'Result <= R.Capacity;
   --  The most that ever were.

   function Lost (R : Ring) return Event_Count
   with Global => null;
   --  How many elements were rejected or dropped.

   function Place (R : Ring; Nth : Capacity_Type) return Capacity_Type
   with
     Global => null,
     Pre    => Nth <= R.Capacity,
     Post   => Place'Result <= R.Capacity;
   --  The place that is Nth from the oldest one in use.

   procedure Put
     (R         : in out Ring;
      When_Full : Queueing.Overflow_Policy;
      Status    : out Queueing.Put_Status;
      Newest    : out Capacity_Type)
   with
     Global         => null,
     Post           =>
       Newest <= R.Capacity
       and then (if Status /= Queueing.Rejected_Full
                 then Newest = Place (R, Length (R)))
       and then Highest (R) = Length_Type'Max (Highest (R'Old), Length (R))
       and then Lost (R) = (if Status = Queueing.Queued
                            then Lost (R'Old)
                            else Next (Lost (R'Old))),
     Contract_Cases =>
       (Length (R) < R.Capacity                     =>
          Status = Queueing.Queued
          and then Length (R) = Length (R'Old) + 1
          and then (for all I in 1 .. Length (R'Old) =>
                      Place (R, I) = Place (R'Old, I)
                      and then Place (R, I) /= Newest),
        Length (R) = R.Capacity
        and then When_Full = Queueing.Drop_Oldest   =>
          Status = Queueing.Dropped_Oldest
          and then Length (R) = R.Capacity
          and then (for all I in 1 .. R.Capacity - 1 =>
                      Place (R, I) = Place (R'Old, I + 1)
                      and then Place (R, I) /= Newest),
        Length (R) = R.Capacity
        and then When_Full = Queueing.Reject_Newest =>
          Status = Queueing.Rejected_Full
          and then Length (R) = R.Capacity
          and then (for all I in 1 .. R.Capacity =>
                      Place (R, I) = Place (R'Old, I)));
   --  Take the place behind the newest one into use, where that loses no
   --  element or the oldest one; otherwise Newest has no meaning.

   procedure Take
     (R      : in out Ring;
      Status : out Queueing.Take_Status;
      Oldest : out Capacity_Type)
   with
     Global         => null,
     Post           =>
       Oldest <= R.Capacity
       and then Highest (R) = Highest (R'Old)
       and then Lost (R) = Lost (R'Old),
     Contract_Cases =>
       (Length (R) > 0 =>
          Status = Queueing.Taken
          and then Length (R) = Length (R'Old) - 1
          and then Oldest = Place (R'Old, 1)
          and then (for all I in 1 .. Length (R) =>
                      Place (R, I) = Place (R'Old, I + 1)),
        Length (R) = 0 =>
          Status = Queueing.Empty and then Length (R) = 0);
   --  Give the oldest place in use back; when Empty, Oldest has no meaning.

private

   type Ring (Capacity : Capacity_Type) is record
      First    : Capacity_Type := 1;
      Count    : Length_Type := 0;
      Most     : Length_Type := 0;
      Given_Up : Event_Count := 0;
   end record
   with
     Predicate =>
       First <= Capacity and then Count <= Most and then Most <= Capacity;
   --  The oldest place in use is First; the next ones follow and wrap.

end Ravenchart.Rings;
