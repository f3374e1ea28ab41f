--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A key for authentication.

with Ravenchart.Can.Authentication;

package Example_Key is

   Key : constant Ravenchart.Can.Authentication.Tag_Bytes :=
     (16#2B#, 16#7E#, 16#15#, 16#16#, 16#28#, 16#AE#, 16#D2#, 16#A6#,
      16#AB#, 16#F7#, 16#15#, 16#88#, 16#09#, 16#CF#, 16#4F#, 16#3C#);
   --  The key of the examples of RFC 4493.

end Example_Key;
