with GNAT.IO;

package body Lines is

   procedure Put (C : Character) is
   begin
      GNAT.IO.Put (C);
   end Put;

end Lines;
