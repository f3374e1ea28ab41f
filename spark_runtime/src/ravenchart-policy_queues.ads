--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  First-in first-out queue of fixed capacity that gives up an element when it
--  is full: the value in every protected object that queues.
--
--  Guarantees   no heap, no overrun, strict order; a full queue gives up one
--               element by its policy and counts it once; every operation is
--               total. The contracts state that on Nth
--  Tasking      none of its own: one protected object owns each Queue
--  Timing       every operation takes constant time and never blocks

with Ravenchart.Queueing;
with Ravenchart.Rings;

generic
   type Element_Type is private;
   Null_Element : Element_Type;
   --  Fills the places that hold no element; Take returns it when there is no
   --  element.
package Ravenchart.Policy_Queues
  with SPARK_Mode, Pure
is
   pragma Assertion_Policy
     (Ghost => Ignore, Post => Ignore, Contract_Cases => Ignore);
   --  Proved, never executed: the check of a Post copies the queue, which is
   --  too large for the stack of a task.

   use type Queueing.Overflow_Policy;
   use type Queueing.Put_Status;
   use type Queueing.Take_Status;

   subtype Length_Type is Queueing.Length_Type;
   subtype Capacity_Type is Queueing.Capacity_Type;

   type Queue (Capacity : Capacity_Type) is private
   with
     Default_Initial_Condition =>
       Length (Queue) = 0
       and then Highest (Queue) = 0
       and then Lost (Queue) = 0;
   --  The elements put and not yet taken, oldest first.

   function Length (Q : Queue) return Length_Type
   with
     Global => null,
     Post   => Length'Result <= Highest (Q);
   --  How many elements wait.

   function Highest (Q : Queue) return Length_Type
   with
     Global => null,
     Post   => Highest'Result <= Q.Capacity;
   --  The most that ever waited.

   function Lost (Q : Queue) return Event_Count
   with Global => null;
   --  How many elements were rejected or dropped.

   --  Ghost model: the queued elements by age.

   function Nth (Q : Queue; Index : Capacity_Type) return Element_Type
   with
     Ghost,
     Global => null,
     Pre    => Index <= Length (Q);
   --  The element that is number Index from the oldest.

   function Keeps
     (Now : Queue; Before : Queue; Count : Length_Type) return Boolean
   is (for all I in 1 .. Count => Nth (Now, I) = Nth (Before, I))
   with
     Ghost,
     Global => null,
     Pre    => Count <= Length (Now) and then Count <= Length (Before);
   --  The oldest Count elements are the same ones.

   function Moves_Up (Now : Queue; Before : Queue; Count : Length_Type)
     return Boolean
   is (for all I in 1 .. Count => Nth (Now, I) = Nth (Before, I + 1))
   with
     Ghost,
     Global => null,
     Pre    => Count <= Length (Now) and then Count < Length (Before);
   --  The oldest Count elements are those that followed the oldest one.

   --  Operations

   procedure Put
     (Q         : in out Queue;
      Item      : Element_Type;
      When_Full : Queueing.Overflow_Policy;
      Status    : out Queueing.Put_Status)
   with
     Global         => null,
     Post           =>
       Highest (Q) = Length_Type'Max (Highest (Q'Old), Length (Q))
       and then
         Lost (Q) =
           (if Status = Queueing.Queued
            then Lost (Q'Old)
            else Next (Lost (Q'Old)))
       and then (if Status /= Queueing.Rejected_Full
                 then Nth (Q, Length (Q)) = Item),
     Contract_Cases =>
       (Length (Q) < Q.Capacity                     =>
          Status = Queueing.Queued
          and then Length (Q) = Length (Q'Old) + 1
          and then Keeps (Q, Q'Old, Length (Q'Old)),
        Length (Q) = Q.Capacity
        and then When_Full = Queueing.Drop_Oldest   =>
          Status = Queueing.Dropped_Oldest
          and then Length (Q) = Q.Capacity
          and then Moves_Up (Q, Q'Old, Q.Capacity - 1),
        Length (Q) = Q.Capacity
        and then When_Full = Queueing.Reject_Newest =>
          Status = Queueing.Rejected_Full
          and then Length (Q) = Q.Capacity
          and then Keeps (Q, Q'Old, Q.Capacity));
   --  Append Item behind the newest element; a full queue gives up Item or its
   --  oldest element.

   procedure Take
     (Q      : in out Queue;
      Item   : out Element_Type;
      Status : out Queueing.Take_Status)
   with
     Global         => null,
     Post           =>
       Highest (Q) = Highest (Q'Old) and then Lost (Q) = Lost (Q'Old),
     Contract_Cases =>
       (Length (Q) > 0 =>
          Status = Queueing.Taken
          and then Item = Nth (Q'Old, 1)
          and then Length (Q) = Length (Q'Old) - 1
          and then Moves_Up (Q, Q'Old, Length (Q)),
        Length (Q) = 0 =>
          Status = Queueing.Empty
          and then Item = Null_Element
          and then Length (Q) = 0);
   --  Remove the oldest element and hand it over, or Null_Element when Empty.

private

   type Element_Array is array (Positive range <>) of Element_Type;

   type Queue (Capacity : Capacity_Type) is record
      Store  : Element_Array (1 .. Capacity) := (others => Null_Element);
      Places : Rings.Ring (Capacity);
   end record;
   --  Places holds the indices in Store of the elements.

end Ravenchart.Policy_Queues;
