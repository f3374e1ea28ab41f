--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The transitions that one step of a region has taken, in their order.
--
--  The segments of its path follow each transition: the transitions that
--  continue from a choice or a history.
--
--  Guarantees   strict order, no heap
--  Tasking      none of its own: the region's activity owns its lists
--  Timing       constant

generic
   type Selection is (<>);
   --  The transitions of a region in their declared order.
   No_Selection : Selection;
   --  Fills the places that hold no transition.
   with function Is_Segment (T : Selection) return Boolean;
   --  Does T continue from a choice or a history?
   Most_Segments : Natural;
   --  The most segments that follow one transition.
   Capacity : Positive;
   --  The most transitions that one step takes, with segments.
package Ravenchart.Firing_Lists
  with SPARK_Mode, Pure
is
   subtype Length is Natural range 0 .. Capacity;

   type Selection_Array is array (Positive range 1 .. Capacity) of Selection;

   type List is record
      Count : Length := 0;
      Items : Selection_Array := (others => No_Selection);
   end record;
   --  The transitions taken: the first Count items.

   Nothing : constant List := (Count => 0, Items => (others => No_Selection));

   function Has (Fired : List; T : Selection) return Boolean
   is (for some I in 1 .. Fired.Count => Fired.Items (I) = T)
   with Global => null;
   --  Is T taken?

   function Is_Added
     (Before : List; T : Selection; After : List) return Boolean
   is (After.Count > Before.Count
       and then After.Count - Before.Count - 1 <= Most_Segments
       and then After.Items (Before.Count + 1) = T
       and then (for all I in 1 .. Before.Count =>
                   After.Items (I) = Before.Items (I))
       and then (for all I in Before.Count + 2 .. After.Count =>
                   Is_Segment (After.Items (I))))
   with
     Ghost,
     Global => null;
   --  Is T taken after Before, followed by its segments and nothing else?

   function Is_Only (Fired : List; T : Selection) return Boolean
   is (Is_Added (Nothing, T, Fired))
   with
     Ghost,
     Global => null;
   --  Is T taken, followed by its segments and nothing else?

   function Is_Ordered (Fired : List) return Boolean
   is (for all I in 1 .. Fired.Count =>
         Is_Segment (Fired.Items (I))
         or else (for all J in 1 .. I - 1 =>
                    Is_Segment (Fired.Items (J))
                    or else Fired.Items (J) < Fired.Items (I)))
   with
     Ghost,
     Global => null;
   --  Are all transitions but segments in the declared order?

   procedure Add (Fired : in out List; T : Selection)
   with
     Global => null,
     Pre    => Fired.Count < Capacity,
     Post   =>
       Fired.Count = Fired.Count'Old + 1
       and then Fired.Items (Fired.Count) = T
       and then (for all I in 1 .. Fired.Count - 1 =>
                   Fired.Items (I) = Fired.Items'Old (I));
   --  Note that T is taken.

end Ravenchart.Firing_Lists;
