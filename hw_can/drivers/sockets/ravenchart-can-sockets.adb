--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Linux_Calls;

package body Ravenchart.Can.Sockets
  with SPARK_Mode => Off
--  ASM-005. Sockets are reached through the C library, by address.
is
   use Linux_Calls;

   -----------
   -- Close --
   -----------

   procedure Close (Old : Socket) is
      Ignored : C_Int;
   begin
      Ignored := C_Close (C_Int (Old));
   end Close;

end Ravenchart.Can.Sockets;
