--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces.C.Strings;
with Ravenchart.Can.Linux_Calls;

package body Ravenchart.Can.Driver_Hosts
  with SPARK_Mode => Off
--  ASM-005. The environment and the console are reached through the C library,
--  by address.
is
   use Linux_Calls;

   Complained : Boolean := False
   with Atomic;
   --  What fails is tried again; one message is enough.

   procedure Print (File : C_Int; Text : String);
   --  Write Text and the end of a line to File, unbuffered.

   -----------
   -- Print --
   -----------

   procedure Print (File : C_Int; Text : String) is
      Line    : constant String := Text & ASCII.LF;
      Ignored : Interfaces.C.long;
   begin
      Ignored := C_Write (File, Line'Address, Line'Length);
   end Print;

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
         else Interfaces.C.Strings.Value (Found, Text_Limit));
   end Setting;

   --------------
   -- Announce --
   --------------

   procedure Announce (Text : String; About : String) is
   begin
      Print (Standard_Output, "can: " & Text & About);
   end Announce;

   --------------
   -- Complain --
   --------------

   procedure Complain
     (Reason : String; About : String := ""; Rest : String := "") is
   begin
      if not Complained then
         Complained := True;
         Print (Standard_Error, "error: can: " & Reason & About & Rest);
      end if;
   end Complain;

end Ravenchart.Can.Driver_Hosts;
