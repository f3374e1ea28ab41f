--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Linux_Calls
  with SPARK_Mode => Off
is

   -------------
   -- Setting --
   -------------

   function Setting (Name : String) return String is
      use type Interfaces.C.Strings.chars_ptr;
      Found : constant Interfaces.C.Strings.chars_ptr :=
        C_Get_Environment (Interfaces.C.To_C (Name));
   begin
      return
        (if Found = Interfaces.C.Strings.Null_Ptr then ""
         else Interfaces.C.Strings.Value (Found));
   end Setting;

   -----------
   -- Print --
   -----------

   procedure Print (File : C_Int; Text : String) is
      Line    : constant String := Text & ASCII.LF;
      Ignored : Interfaces.C.long;
   begin
      Ignored := C_Write (File, Line'Address, Line'Length);
   end Print;

end Ravenchart.Can.Linux_Calls;
