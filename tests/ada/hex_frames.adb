--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces;

package body Hex_Frames is

   -----------
   -- Image --
   -----------

   function Image
     (F : Ravenchart.Can.Any_Frames.Any_Frame; Length : Natural)
      return String
   is
      use type Interfaces.Unsigned_8;
      Hex    : constant String := "0123456789abcdef";
      Result : String (1 .. 2 * Length);
      Byte   : Interfaces.Unsigned_8;
   begin
      for I in 0 .. Length - 1 loop
         Byte := Ravenchart.Can.Any_Frames.Byte (F, I);
         Result (2 * I + 1) := Hex (Natural (Byte / 16) + 1);
         Result (2 * I + 2) := Hex (Natural (Byte and 15) + 1);
      end loop;
      return Result;
   end Image;

end Hex_Frames;
