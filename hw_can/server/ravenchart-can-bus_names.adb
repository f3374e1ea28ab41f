--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Bus_Names
  with SPARK_Mode
is

   -----------
   -- Named --
   -----------

   function Named (Text : String) return Bus_Name is
      Result : Bus_Name;
   begin
      Result.Length := Text'Length;
      Result.Letters (1 .. Text'Length) := Text;
      return Result;
   end Named;

end Ravenchart.Can.Bus_Names;
