--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The data of frames as text.

with Ravenchart.Can.Any_Frames;

package Hex_Frames is

   function Image
     (F : Ravenchart.Can.Any_Frames.Any_Frame; Length : Natural)
      return String;
   --  So many bytes, two lower-case digits each.

end Hex_Frames;
