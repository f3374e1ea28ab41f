--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Objects is

   ------------
   -- Answer --
   ------------

   procedure Answer is
   begin
      Dropping_Offers.Offer (99);
   end Answer;

end Objects;
