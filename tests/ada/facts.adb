with Ada.Text_IO;
with GNAT.OS_Lib;

package body Facts is

   Failures : Natural := 0;

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
      GNAT.OS_Lib.OS_Exit (if Failures = 0 then 0 else 1);
   end Finish;

end Facts;
