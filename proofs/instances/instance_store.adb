--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Instance_Store
  with SPARK_Mode
is
   ------------
   -- Answer --
   ------------

   procedure Answer is
   begin
      Dropping_Offers.Offer (Reset);
   end Answer;

end Instance_Store;
