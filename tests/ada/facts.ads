--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The output of every test: one line for each fact, and the exit status.

package Facts is

   procedure Check (Fact : String; Holds : Boolean);
   --  Print the line of this fact.

   function All_Hold return Boolean;
   --  Has every fact held so far?

   procedure Finish;
   --  End the program: status 0 when every fact held, else 1. Needed where
   --  tasks run, since they never end.

end Facts;
