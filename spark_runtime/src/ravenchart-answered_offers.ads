--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Offers to a queue whose losses the model reacts to.
--
--  Guarantees   each loss is reported once, and On_Loss is called once for it
--  Tasking      that of Offers and of On_Loss
--  Timing       that of Offers, and with a loss that of On_Loss

with Ravenchart.Offers;
with Ravenchart.Queueing;

generic
   with package Offers is new Ravenchart.Offers (<>);
   with procedure On_Loss;
   --  The reaction of the model. It puts elements into the queue by Offers, so
   --  a loss in it is reported without another call.
package Ravenchart.Answered_Offers
  with SPARK_Mode
is
   procedure Offer
     (Item      : Offers.Element_Type;
      When_Full : Queueing.Overflow_Policy := Offers.Policy);
   --  Queue Item; report the element that a full queue gives up, and call
   --  On_Loss.

end Ravenchart.Answered_Offers;
