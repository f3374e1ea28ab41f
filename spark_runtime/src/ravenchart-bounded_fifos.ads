--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  First-in first-out buffer of fixed capacity: the store behind every queue.
--
--  Guarantees   no heap, no overrun, strict order; all stated on Nth below
--  Tasking      none of its own: one protected object owns each Fifo
--  Timing       every operation takes constant time and never blocks

with Ravenchart.Queueing;
with Ravenchart.Rings;

generic
   type Element_Type is private;
   Null_Element : Element_Type;
   --  Fills the places that hold no element.
package Ravenchart.Bounded_Fifos
  with SPARK_Mode, Pure
is
   pragma Assertion_Policy (Ghost => Ignore, Post => Ignore);
   --  Proved, never executed: to check a Post means to copy the buffer, which
   --  is too much for the stack of a task.

   subtype Length_Type is Queueing.Length_Type;
   subtype Capacity_Type is Queueing.Capacity_Type;

   type Fifo (Capacity : Capacity_Type) is private
   with Default_Initial_Condition => Length (Fifo) = 0;
   --  The elements put and not yet taken, oldest first.

   function Length (Queue : Fifo) return Length_Type
   with
     Global => null,
     Post   => Length'Result <= Queue.Capacity;
   --  How many elements are queued.

   --  Ghost model: the queued elements by age. The contracts speak of
   --  nothing else.
   function Nth (Queue : Fifo; Index : Capacity_Type) return Element_Type
   with
     Ghost,
     Global => null,
     Pre    => Index <= Length (Queue);
   --  The element that is number Index from the oldest.

   procedure Put (Queue : in out Fifo; Item : Element_Type)
   with
     Global => null,
     Pre    => Length (Queue) < Queue.Capacity,
     Post   =>
       Length (Queue) = Length (Queue)'Old + 1
       and then Nth (Queue, Length (Queue)) = Item
       and then (for all I in 1 .. Length (Queue'Old) =>
                   Nth (Queue, I) = Nth (Queue'Old, I));
   --  Append Item behind the newest element.

   procedure Get (Queue : in out Fifo; Item : out Element_Type)
   with
     Global => null,
     Pre    => Length (Queue) > 0,
     Post   =>
       Length (Queue) = Length (Queue)'Old - 1
       and then Item = Nth (Queue'Old, 1)
       and then (for all I in 1 .. Length (Queue) =>
                   Nth (Queue, I) = Nth (Queue'Old, I + 1));
   --  Remove the oldest element and hand it to the caller.

   procedure Replace_Oldest (Queue : in out Fifo; Item : Element_Type)
   with
     Global => null,
     Pre    => Length (Queue) > 0,
     Post   =>
       Length (Queue) = Length (Queue)'Old
       and then Nth (Queue, Length (Queue)) = Item
       and then (for all I in 1 .. Length (Queue) - 1 =>
                   Nth (Queue, I) = Nth (Queue'Old, I + 1));
   --  Drop the oldest element, and append Item behind the newest.

private

   type Element_Array is array (Positive range <>) of Element_Type;

   type Fifo (Capacity : Capacity_Type) is record
      Store  : Element_Array (1 .. Capacity) := (others => Null_Element);
      Places : Rings.Ring (Capacity);
   end record;
   --  Places says where in Store the elements are.

end Ravenchart.Bounded_Fifos;
