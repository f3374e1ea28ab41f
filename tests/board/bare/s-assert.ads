--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What a contract that does not hold raises.

package System.Assertions is

   Assert_Failure : exception;

   procedure Raise_Assert_Failure (Msg : String)
   with No_Return;

end System.Assertions;
