--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The places of a ring buffer, without its elements: where the next element
--  goes, and where the oldest one is. Proved once here, so that each instance
--  of a buffer has little left to prove.
--
--  Guarantees   the places in use are distinct and keep the order of arrival
--  Tasking      none of its own: the buffer owns its Ring
--  Timing       constant

with Ravenchart.Queueing;

package Ravenchart.Rings
  with SPARK_Mode, Pure
is
   pragma Assertion_Policy (Post => Ignore);
   --  Proved, never executed: to check a Post takes time linear in the length.

   subtype Length_Type is Queueing.Length_Type;
   subtype Capacity_Type is Queueing.Capacity_Type;

   type Ring (Capacity : Capacity_Type) is private
   with Default_Initial_Condition => Length (Ring) = 0;
   --  Places 1 .. Capacity, of which some are in use.

   function Length (R : Ring) return Length_Type
   with
     Global => null,
     Post   => Length'Result <= R.Capacity;
   --  How many places are in use.

   function Place (R : Ring; Nth : Capacity_Type) return Capacity_Type
   with
     Global => null,
     Pre    => Nth <= R.Capacity,
     Post   => Place'Result <= R.Capacity;
   --  The place that is Nth from the oldest one in use.

   procedure Extend (R : in out Ring; Newest : out Capacity_Type)
   with
     Global => null,
     Pre    => Length (R) < R.Capacity,
     Post   =>
       Length (R) = Length (R)'Old + 1
       and then Newest <= R.Capacity
       and then Newest = Place (R, Length (R))
       and then (for all I in 1 .. Length (R'Old) =>
                   Place (R, I) = Place (R'Old, I)
                   and then Place (R, I) /= Newest);
   --  Take the place behind the newest one into use.

   procedure Shrink (R : in out Ring; Oldest : out Capacity_Type)
   with
     Global => null,
     Pre    => Length (R) > 0,
     Post   =>
       Length (R) = Length (R)'Old - 1
       and then Oldest <= R.Capacity
       and then Oldest = Place (R'Old, 1)
       and then (for all I in 1 .. Length (R) =>
                   Place (R, I) = Place (R'Old, I + 1));
   --  Give the oldest place in use back.

private

   type Ring (Capacity : Capacity_Type) is record
      First : Capacity_Type := 1;
      Count : Length_Type := 0;
   end record
   with
     Predicate => First <= Capacity and then Count <= Capacity;
   --  The oldest place in use is First; the next ones follow and wrap.

end Ravenchart.Rings;
