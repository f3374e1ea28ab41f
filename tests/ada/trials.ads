--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What the command line says of a test: how often random things are tried,
--  or that it is to print.

package Trials is

   function Times return Positive;
   --  The first argument, 10 without it.

   function Prints return Boolean;
   --  Is the first argument "print"?

end Trials;
