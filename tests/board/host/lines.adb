--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with GNAT.IO;

package body Lines is

   procedure Put (C : Character) is
   begin
      GNAT.IO.Put (C);
   end Put;

end Lines;
