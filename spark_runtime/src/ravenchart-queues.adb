--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Bounded_Fifos;

package body Ravenchart.Queues
  with SPARK_Mode, Refined_State => (State => Queue)
is
   use type Queueing.Overflow_Policy;

   package Fifos is new Bounded_Fifos
     (Element_Type => Element_Type,
      Null_Element => Null_Element);

   protected Queue
     with Priority => Ceiling
   is
      procedure Put
        (Item      : Element_Type;
         When_Full : Queueing.Overflow_Policy;
         Status    : out Queueing.Put_Status);

      procedure Take
        (Item : out Element_Type; Status : out Queueing.Take_Status);

      function Lost return Event_Count;

   private
      Store    : Fifos.Fifo (Capacity);
      Given_Up : Event_Count := 0;
   end Queue;

   protected body Queue is

      procedure Put
        (Item      : Element_Type;
         When_Full : Queueing.Overflow_Policy;
         Status    : out Queueing.Put_Status) is
      begin
         if Fifos.Length (Store) < Capacity then
            Fifos.Put (Store, Item);
            Status := Queueing.Queued;
         elsif When_Full = Queueing.Drop_Oldest then
            Fifos.Replace_Oldest (Store, Item);
            Given_Up := Next (Given_Up);
            Status   := Queueing.Dropped_Oldest;
         else
            Given_Up := Next (Given_Up);
            Status   := Queueing.Rejected_Full;
         end if;
      end Put;

      procedure Take
        (Item : out Element_Type; Status : out Queueing.Take_Status) is
      begin
         if Fifos.Length (Store) > 0 then
            Fifos.Get (Store, Item);
            Status   := Queueing.Taken;
         else
            Item   := Null_Element;
            Status := Queueing.Empty;
         end if;
      end Take;

      function Lost return Event_Count
      is (Given_Up);

   end Queue;

   procedure Put
     (Item      : Element_Type;
      Status    : out Queueing.Put_Status;
      When_Full : Queueing.Overflow_Policy := Policy)
   with Refined_Global => (In_Out => Queue)
   is
   begin
      Queue.Put (Item, When_Full, Status);
   end Put;

   procedure Take (Item : out Element_Type; Status : out Queueing.Take_Status)
   with Refined_Global => (In_Out => Queue)
   is
   begin
      Queue.Take (Item, Status);
   end Take;

   function Lost return Event_Count
   with Refined_Global => Queue
   is
   begin
      return Queue.Lost;
   end Lost;

end Ravenchart.Queues;
