--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Policy_Queues;

package body Ravenchart.Queues
  with SPARK_Mode, Refined_State => (State => Queue)
is
   package Values is new Policy_Queues
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

      function Fill return Queueing.Fill;

      function Lost return Event_Count;

   private
      Value : Values.Queue (Capacity);
   end Queue;

   protected body Queue is

      procedure Put
        (Item      : Element_Type;
         When_Full : Queueing.Overflow_Policy;
         Status    : out Queueing.Put_Status) is
      begin
         Values.Put (Value, Item, When_Full, Status);
      end Put;

      procedure Take
        (Item : out Element_Type; Status : out Queueing.Take_Status) is
      begin
         Values.Take (Value, Item, Status);
      end Take;

      function Fill return Queueing.Fill
      is (Now => Values.Length (Value), Highest => Values.Highest (Value));

      function Lost return Event_Count
      is (Values.Lost (Value));

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

   procedure Read_Fill (Found : out Queueing.Fill)
   with Refined_Global => Queue
   is
   begin
      Found := Queue.Fill;
   end Read_Fill;

   function Is_Empty return Boolean
   with Refined_Global => Queue
   is
      Found : constant Queueing.Fill := Queue.Fill;
   begin
      return Found.Now = 0;
   end Is_Empty;

   function Lost return Event_Count
   with Refined_Global => Queue
   is
   begin
      return Queue.Lost;
   end Lost;

end Ravenchart.Queues;
