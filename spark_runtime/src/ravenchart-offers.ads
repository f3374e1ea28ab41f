--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Puts elements into a queue; the loss of an element is a fault.
--
--  Guarantees   each loss is reported once, for Element
--  Tasking      any task that may call the actual procedures
--  Timing       that of the queue, and after a loss that of the report

with Ravenchart.Health;
with Ravenchart.Queueing;

generic
   type Element_Type is private;
   with procedure Put
     (Item      : Element_Type;
      Status    : out Queueing.Put_Status;
      When_Full : Queueing.Overflow_Policy);
   --  The operation Put of the queue.
   Policy : Queueing.Overflow_Policy;
   --  The policy of an offer that names no other one.
   Element : Element_Id;
   --  The model element that owns the queue.
   with procedure Report (Kind : Health.Fault_Kind; Element : Element_Id);
package Ravenchart.Offers
  with SPARK_Mode
is
   procedure Offer
     (Item      : Element_Type;
      When_Full : Queueing.Overflow_Policy := Policy);
   --  Queue Item; report the element that a full queue gives up.

   procedure Offer_And_Tell
     (Item      : Element_Type;
      Lost      : out Boolean;
      When_Full : Queueing.Overflow_Policy := Policy);
   --  The same. Lost: has the queue given up an element?

end Ravenchart.Offers;
