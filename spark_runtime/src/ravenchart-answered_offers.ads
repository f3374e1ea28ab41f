--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Offers to a queue whose losses the model answers.
--
--  Guarantees   each loss is reported once, and then answered once
--  Tasking      as of Offers and of On_Loss
--  Timing       that of Offers, and with a loss that of On_Loss

with Ravenchart.Offers;
with Ravenchart.Queueing;

generic
   with package Offers is new Ravenchart.Offers (<>);
   with procedure On_Loss;
   --  The answer. What it puts into the queue itself goes by Offers, so a loss
   --  on that way is reported, and not answered again.
package Ravenchart.Answered_Offers
  with SPARK_Mode
is
   procedure Offer
     (Item      : Offers.Element_Type;
      When_Full : Queueing.Overflow_Policy := Offers.Policy);
   --  Queue Item; report what the queue gives up for it, and call On_Loss.

end Ravenchart.Answered_Offers;
