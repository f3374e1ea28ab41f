--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Text_IO;
with Interfaces.C;

package body Facts is

   Failures : Natural := 0;

   procedure C_Exit (Status : Interfaces.C.int)
   with Import, Convention => C, External_Name => "_exit";
   --  Ends the process without finalization: tasks still run, and a wait for
   --  their objects could take for ever.

   procedure Check (Fact : String; Holds : Boolean) is
   begin
      if Holds then
         Ada.Text_IO.Put_Line ("ok " & Fact);
      else
         Ada.Text_IO.Put_Line ("not ok " & Fact);
         Failures := Failures + 1;
      end if;
   end Check;

   function All_Hold return Boolean
   is (Failures = 0);

   procedure Finish is
   begin
      Ada.Text_IO.Flush;
      C_Exit (if Failures = 0 then 0 else 1);
   end Finish;

end Facts;
