--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Shared_Slots;

package body Ravenchart.Crossing_Queues
  with
    SPARK_Mode,
    Refined_State => (State => (Head, Tail, Rejected, Slots.State))
is
   --  The steps have the names that proofs/interleavings/ring_steps.ads gives
   --  them. One place more than Capacity: a full ring is not an empty one.

   package Slots is new Shared_Slots
     (Element_Type => Element_Type,
      Initial      => Null_Element,
      Last         => Capacity);

   Head : Slots.Place_Number := 0
   with Atomic, Async_Readers, Async_Writers;
   --  The place of the oldest element: written by the consumer.

   Tail : Slots.Place_Number := 0
   with Atomic, Async_Readers, Async_Writers;
   --  The place of the next element: written by the producer.

   Rejected : Natural := 0
   with Atomic, Async_Readers, Async_Writers;

   function Following (Place : Slots.Place_Number) return Slots.Place_Number
   is (if Place = Capacity then 0 else Place + 1)
   with Global => null;

   procedure Put (Item : Element_Type; Status : out Queueing.Put_Status)
   with
     Refined_Global =>
       (Input  => Head,
        In_Out => (Tail, Rejected, Slots.State))
   is
      First : Slots.Place_Number;
      Free  : Slots.Place_Number;
      Count : Natural;
   begin
      First := Head;  --  Find_Room
      Free  := Tail;
      if Following (Free) = First then
         Count    := Rejected;
         Rejected := (if Count = Natural'Last then Count else Count + 1);
         Status   := Queueing.Rejected_Full;
      else
         Slots.Write (Free, Item);  --  Fill
         Tail   := Following (Free);  --  Show
         Status := Queueing.Queued;
      end if;
   end Put;

   procedure Take (Item : out Element_Type; Status : out Queueing.Take_Status)
   with
     Refined_Global =>
       (Input  => (Tail, Slots.State),
        In_Out => Head)
   is
      First : Slots.Place_Number;
      Free  : Slots.Place_Number;
   begin
      Free  := Tail;  --  Find_Element
      First := Head;
      if First = Free then
         Item   := Null_Element;
         Status := Queueing.Empty;
      else
         Slots.Read (First, Item);
         Head   := Following (First);  --  End_Copy
         Status := Queueing.Taken;
      end if;
   end Take;

   function Lost return Event_Count
   with Refined_Global => Rejected
   is
      Count : constant Natural := Rejected;
   begin
      return Event_Count (Count);
   end Lost;

end Ravenchart.Crossing_Queues;
