--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Every interleaving of the producer and the consumer of a queue that two
--  cores share (Ravenchart.Crossing_Queues), as Four_Slot_Steps does for a
--  board.
--
--  Guarantees   contract: no place is read while it is written; the elements
--               come in their order, each once
--  Assumptions  ASM-023, both tasks see the steps in one order

package Ring_Steps
  with SPARK_Mode, Pure
is
   subtype Capacity_Type is Positive range 1 .. 65_536;

   subtype Place_Number is Natural range 0 .. Capacity_Type'Last;

   type Number is range 0 .. 2**62;
   --  The elements in the order in which they are put, from 0.

   type Producer_Place is (Idle, Room_Found, Filling);
   --  The step that the producer did last.

   type Consumer_Place is (Idle, Copying);
   --  The step that the consumer did last. Copying begins with Find_Element.

   type Numbers is array (Place_Number) of Number;

   type Ring (Capacity : Capacity_Type) is record
      --  Both tasks access these.
      Head  : Place_Number := 0;
      Tail  : Place_Number := 0;
      Slots : Numbers      := (others => 0);

      --  Each task knows its own.
      Producer : Producer_Place := Idle;
      Consumer : Consumer_Place := Idle;

      --  Only the proof needs these.
      Put   : Number := 0;
      --  How many elements were put: the number of the next one.
      Taken : Number := 0;
      --  How many elements were taken.
   end record;

   function Following (R : Ring; Place : Place_Number) return Place_Number
   is (if Place = R.Capacity then 0 else Place + 1)
   with Pre => Place <= R.Capacity;

   function Length (R : Ring) return Number
   is (if R.Tail >= R.Head then Number (R.Tail - R.Head)
       else Number (R.Tail + R.Capacity + 1 - R.Head))
   with Pre => R.Head <= R.Capacity and then R.Tail <= R.Capacity;
   --  The elements between Head and Tail.

   function Element (R : Ring; Place : Place_Number) return Number
   is (if Place >= R.Head then R.Taken + Number (Place - R.Head)
       else R.Taken + Number (Place + R.Capacity + 1 - R.Head))
   with
     Pre =>
       R.Head <= R.Capacity
       and then Place <= R.Capacity
       and then R.Taken < Number'Last - 2**18;
   --  The number of the element that belongs into a place.

   function Is_Used (R : Ring; Place : Place_Number) return Boolean
   is (if R.Head <= R.Tail then Place >= R.Head and then Place < R.Tail
       else Place >= R.Head or else Place < R.Tail);
   --  Is the place between Head and Tail?

   function Collides (R : Ring) return Boolean
   is (R.Producer = Filling
       and then R.Consumer = Copying
       and then R.Head = R.Tail);
   --  Is a place read while it is written?

   function Is_Sound (R : Ring) return Boolean
   is (not Collides (R)
       and then R.Head <= R.Capacity
       and then R.Tail <= R.Capacity
       and then R.Taken < Number'Last - 2**18
       and then R.Put = R.Taken + Length (R)
       and then Length (R) <= Number (R.Capacity)
       and then (for all P in 0 .. R.Capacity =>
                   (if Is_Used (R, P) then R.Slots (P) = Element (R, P)))
       and then (if R.Producer /= Idle
                 then Length (R) < Number (R.Capacity))
       and then (if R.Producer = Filling then R.Slots (R.Tail) = R.Put)
       and then (if R.Consumer = Copying then R.Head /= R.Tail));

   --  The producer

   procedure Find_Room (R : in out Ring)
   with
     Pre  => Is_Sound (R) and then R.Producer = Idle,
     Post =>
       Is_Sound (R)
       and then (R.Producer = Room_Found)
                = (Length (R) < Number (R.Capacity));
   --  With no room the producer rejects the element, and is Idle again.

   procedure Fill (R : in out Ring)
   with
     Pre  => Is_Sound (R) and then R.Producer = Room_Found,
     Post => Is_Sound (R) and then R.Producer = Filling;

   procedure Show (R : in out Ring)
   with
     Pre  => Is_Sound (R) and then R.Producer = Filling,
     Post =>
       Is_Sound (R) and then R.Producer = Idle and then R.Put = R.Put'Old + 1;

   --  The consumer

   procedure Find_Element (R : in out Ring)
   with
     Pre  => Is_Sound (R) and then R.Consumer = Idle,
     Post =>
       Is_Sound (R) and then (R.Consumer = Copying) = (R.Put > R.Taken);
   --  With no element the consumer is Idle again.

   procedure End_Copy (R : in out Ring; Got : out Number)
   with
     Pre  =>
       Is_Sound (R)
       and then R.Consumer = Copying
       and then R.Taken < Number'Last - 2**18 - 1,
     Post =>
       Is_Sound (R)
       and then R.Consumer = Idle
       and then Got = R.Taken'Old
       and then R.Taken = R.Taken'Old + 1;
   --  Read the element, and release its place.

end Ring_Steps;
