--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Synchronous_Task_Control;
with Ravenchart.Bounded_Fifos;

package body Ravenchart.Releasing_Queues
  with SPARK_Mode, Refined_State => (State => Queue, Wake_Up => Filled)
is
   use Ada.Synchronous_Task_Control;
   use type Queueing.Overflow_Policy;

   pragma Warnings
     (GNATprove, Off, "no Always_Terminates aspect available*",
      Reason => "ASM-008, the library does not say it of suspension objects");
   pragma Warnings
     (GNATprove, Off, "assuming * always terminates",
      Reason => "ASM-008, the library does not say it of suspension objects");

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

      function Is_Empty return Boolean;

      function Lost return Event_Count;

   private
      Store    : Fifos.Fifo (Capacity);
      Given_Up : Event_Count := 0;
   end Queue;

   Filled : Suspension_Object;
   --  True when an element may have come since the caller of Wait looked.

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

      function Is_Empty return Boolean
      is (Fifos.Length (Store) = 0);

      function Lost return Event_Count
      is (Given_Up);

   end Queue;

   procedure Put
     (Item      : Element_Type;
      Status    : out Queueing.Put_Status;
      When_Full : Queueing.Overflow_Policy := Policy)
   with Refined_Global => (In_Out => (Queue, Filled))
   is
   begin
      Queue.Put (Item, When_Full, Status);
      Set_True (Filled);
   end Put;

   procedure Take (Item : out Element_Type; Status : out Queueing.Take_Status)
   with Refined_Global => (In_Out => Queue)
   is
   begin
      Queue.Take (Item, Status);
   end Take;

   procedure Wait
   with Refined_Global => (In_Out => (Queue, Filled))
   is
      Nothing_Waits : Boolean;
   begin
      loop
         Nothing_Waits := Queue.Is_Empty;
         exit when not Nothing_Waits;
         Suspend_Until_True (Filled);
      end loop;
   end Wait;

   function Is_Empty return Boolean
   with Refined_Global => Queue
   is
   begin
      return Queue.Is_Empty;
   end Is_Empty;

   function Lost return Event_Count
   with Refined_Global => Queue
   is
   begin
      return Queue.Lost;
   end Lost;

end Ravenchart.Releasing_Queues;
