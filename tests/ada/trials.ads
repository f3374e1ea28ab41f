--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The command line of a test: the number of random trials, or the request to
--  print.

package Trials is

   function Times return Positive;
   --  The first argument, 10 by default.

   function Prints return Boolean;
   --  Is the first argument "print"?

end Trials;
