--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The events raised in one step of a region, in the order they were raised.
--
--  Guarantees   strict order, no heap, total operations
--  Tasking      none of its own: the region's activity owns its lists
--  Timing       constant

generic
   type Event is private;
   Null_Event : Event;
   --  Fills the places that hold no event.
   Capacity : Positive;
   --  The most events one step can raise; the generator computes it.
package Ravenchart.Event_Lists
  with SPARK_Mode, Pure
is
   type List is private
   with Default_Initial_Condition => Count (List) = 0;
   --  Up to Capacity events.

   subtype Length is Natural range 0 .. Capacity;
   --  How many events a list can hold.

   function Count (L : List) return Length
   with Global => null;
   --  How many events L holds.

   function Element (L : List; Index : Positive) return Event
   with
     Global => null,
     Pre    => Index <= Count (L);
   --  The event that was raised as number Index.

   function Is_Appended
     (Before : List; Item : Event; After : List) return Boolean
   is (if Count (Before) = Capacity
       then After = Before
       else Count (After) = Count (Before) + 1
            and then Element (After, Count (After)) = Item
            and then (for all I in 1 .. Count (Before) =>
                        Element (After, I) = Element (Before, I)))
   with
     Ghost,
     Global => null;
   --  After is Before with Item as its last event, if there was room for it.

   procedure Append (L : in out List; Item : Event)
   with
     Global => null,
     Post   => Is_Appended (L'Old, Item, L);
   --  Add Item as the last event; a full list ignores it.

   function Is_Removed
     (Before : List; Index : Positive; After : List) return Boolean
   is (Index <= Count (Before)
       and then Count (After) = Count (Before) - 1
       and then (for all I in 1 .. Count (After) =>
                   Element (After, I) =
                     Element (Before, (if I < Index then I else I + 1))))
   with
     Ghost,
     Global => null;
   --  After is Before without the event that was added as number Index.

   procedure Remove (L : in out List; Index : Positive)
   with
     Global => null,
     Pre    => Index <= Count (L),
     Post   => Is_Removed (L'Old, Index, L);
   --  Take the event that was added as number Index out of the list.

   procedure Clear (L : out List)
   with
     Global => null,
     Post   => Count (L) = 0;
   --  Forget all events.

private

   type Event_Array is array (Positive range 1 .. Capacity) of Event;

   type List is record
      Events : Event_Array := (others => Null_Event);
      Used   : Length := 0;
   end record;
   --  The events are the first Used ones.

   function Count (L : List) return Length
   is (L.Used);

   function Element (L : List; Index : Positive) return Event
   is (L.Events (Index));

end Ravenchart.Event_Lists;
