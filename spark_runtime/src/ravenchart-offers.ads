--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Puts elements into a queue; an element that the queue gives up is a fault.
--
--  Guarantees   each loss is reported once, about Element
--  Tasking      any task that may call the actual procedures
--  Timing       that of the queue, and with a loss that of the report

with Ravenchart.Health;
with Ravenchart.Queueing;

generic
   type Element_Type is private;
   with procedure Put
     (Item      : Element_Type;
      Status    : out Queueing.Put_Status;
      When_Full : Queueing.Overflow_Policy);
   --  That of the queue.
   Policy : Queueing.Overflow_Policy;
   --  For elements that are offered without another.
   Element : Element_Id;
   --  What the queue belongs to.
   with procedure Report (Kind : Health.Fault_Kind; Element : Element_Id);
package Ravenchart.Offers
  with SPARK_Mode
is
   procedure Offer
     (Item      : Element_Type;
      When_Full : Queueing.Overflow_Policy := Policy);
   --  Queue Item; report what the queue gives up for it.

   procedure Offer_And_Tell
     (Item      : Element_Type;
      Lost      : out Boolean;
      When_Full : Queueing.Overflow_Policy := Policy);
   --  The same; Lost: has the queue given up something?

end Ravenchart.Offers;
