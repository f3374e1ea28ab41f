--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  AES-CMAC with 128 bits (RFC 4493), by libcrypto of OpenSSL 3: for tests.
--
--  Guarantees   none: the body is outside SPARK
--  Tasking      any task may call it
--  Timing       that of the library

with Ravenchart.Can.Authentication;

package Aes_Cmac
  with SPARK_Mode
is
   use Ravenchart.Can.Authentication;

   function Cmac (Key : Tag_Bytes; Item : Mac_Input) return Mac_Answer
   with Global => null;
   --  The MAC of the first Item.Length bytes.

end Aes_Cmac;
