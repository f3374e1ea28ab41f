--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Offers
  with SPARK_Mode
is
   use type Queueing.Put_Status;

   -----------
   -- Offer --
   -----------

   procedure Offer
     (Item      : Element_Type;
      When_Full : Queueing.Overflow_Policy := Policy)
   is
      Status : Queueing.Put_Status;
   begin
      Put (Item, Status, When_Full);
      if Status /= Queueing.Queued then
         Report (Health.Queue_Overflow, Element);
      end if;
   end Offer;

   --------------------
   -- Offer_And_Tell --
   --------------------

   procedure Offer_And_Tell
     (Item      : Element_Type;
      Lost      : out Boolean;
      When_Full : Queueing.Overflow_Policy := Policy)
   is
      Status : Queueing.Put_Status;
   begin
      Put (Item, Status, When_Full);
      Lost := Status /= Queueing.Queued;
      if Lost then
         Report (Health.Queue_Overflow, Element);
      end if;
   end Offer_And_Tell;

end Ravenchart.Offers;
