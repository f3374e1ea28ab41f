--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Answered_Offers
  with SPARK_Mode
is
   -----------
   -- Offer --
   -----------

   procedure Offer
     (Item      : Offers.Element_Type;
      When_Full : Queueing.Overflow_Policy := Offers.Policy)
   is
      Lost : Boolean;
   begin
      Offers.Offer_And_Tell (Item, Lost, When_Full);
      if Lost then
         On_Loss;
      end if;
   end Offer;

end Ravenchart.Answered_Offers;
