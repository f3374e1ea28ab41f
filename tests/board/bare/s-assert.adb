--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body System.Assertions is

   procedure Last_Chance (Message : Address; Line : Integer)
   with
     Import,
     Convention    => C,
     External_Name => "__gnat_last_chance_handler",
     No_Return;

   procedure Raise_Assert_Failure (Msg : String) is
   begin
      Last_Chance (Msg'Address, 0);
   end Raise_Assert_Failure;

end System.Assertions;
