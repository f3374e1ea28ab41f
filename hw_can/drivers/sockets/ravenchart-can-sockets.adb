--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Linux_Calls;

package body Ravenchart.Can.Sockets
  with SPARK_Mode => Off
--  ASM-005. Sockets are reached through the C library, by address.
is
   use Linux_Calls;

   Complained : Boolean := False
   with Atomic;
   --  What fails is tried again; one message is enough.

   --------------
   -- Announce --
   --------------

   procedure Announce (Text : String) is
   begin
      Print (Standard_Output, "can: " & Text);
   end Announce;

   --------------
   -- Complain --
   --------------

   procedure Complain (Reason : String) is
   begin
      if not Complained then
         Complained := True;
         Print (Standard_Error, "error: can: " & Reason);
      end if;
   end Complain;

   -----------
   -- Close --
   -----------

   procedure Close (Old : Socket) is
      Ignored : C_Int;
   begin
      Ignored := C_Close (C_Int (Old));
   end Close;

end Ravenchart.Can.Sockets;
