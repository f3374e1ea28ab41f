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
         On_Loss;
      end if;
   end Offer;

   ----------
   -- Tell --
   ----------

   procedure Tell
     (Item      : Element_Type;
      When_Full : Queueing.Overflow_Policy := Policy)
   is
      Status : Queueing.Put_Status;
   begin
      Put (Item, Status, When_Full);
      if Status /= Queueing.Queued then
         Report (Health.Queue_Overflow, Element);
      end if;
   end Tell;

end Ravenchart.Offers;
