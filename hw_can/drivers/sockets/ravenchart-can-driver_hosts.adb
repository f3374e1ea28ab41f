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
   --  The drivers retry; one message is enough.

   procedure Print
     (File : C_Int; Head, Text, About : String; Rest : String := "");
   --  Write the parts and the end of a line to File, unbuffered.

   Digit_Limit : constant := 10;
   --  The digits of a Natural.

   subtype Image is String (1 .. Digit_Limit);

   procedure Format (Number : Natural; Text : out Image; First : out Positive);
   --  In decimal, from First on.

   -----------
   -- Print --
   -----------

   procedure Print
     (File : C_Int; Head, Text, About : String; Rest : String := "")
   is
      Line    : String (1 .. 4 * Text_Limit);
      Last    : Natural := 0;
      Ignored : Interfaces.C.long;

      procedure Add (Part : String);
      --  Append Part.

      procedure Add (Part : String) is
      begin
         Line (Last + 1 .. Last + Part'Length) := Part;
         Last := Last + Part'Length;
      end Add;
   begin
      Add (Head);
      Add (Text);
      Add (About);
      Add (Rest);
      Add ((1 => ASCII.LF));
      Ignored := C_Write (File, Line'Address, Interfaces.C.size_t (Last));
   end Print;

   ------------
   -- Format --
   ------------

   procedure Format (Number : Natural; Text : out Image; First : out Positive)
   is
      Rest : Natural := Number;
   begin
      Text  := (others => '0');
      First := Digit_Limit;
      loop
         Text (First) := Character'Val (Character'Pos ('0') + Rest mod 10);
         Rest         := Rest / 10;
         exit when Rest = 0;
         First := First - 1;
      end loop;
   end Format;

   ------------------
   -- Read_Setting --
   ------------------

   procedure Read_Setting
     (Name : String; Text : out String; Last : out Natural)
   is
      use type Interfaces.C.Strings.chars_ptr;
      Found : constant Interfaces.C.Strings.chars_ptr :=
        C_Get_Environment (Interfaces.C.To_C (Name));
   begin
      Text := (others => ' ');
      Last := 0;
      if Found /= Interfaces.C.Strings.Null_Ptr then
         declare
            Value : constant String :=
              Interfaces.C.Strings.Value (Found, Text'Length);
         begin
            Last := Value'Length;
            Text (1 .. Last) := Value;
         end;
      end if;
   end Read_Setting;

   --------------
   -- Announce --
   --------------

   procedure Announce (Text : String; About : String) is
   begin
      Print (Standard_Output, "can: ", Text, About);
   end Announce;

   procedure Announce (Text : String; Number : Natural) is
      About : Image;
      First : Positive;
   begin
      Format (Number, About, First);
      Announce (Text, About (First .. Digit_Limit));
   end Announce;

   --------------
   -- Complain --
   --------------

   procedure Complain
     (Reason : String; About : String := ""; Rest : String := "") is
   begin
      if not Complained then
         Complained := True;
         Print (Standard_Error, "error: can: ", Reason, About, Rest);
      end if;
   end Complain;

   procedure Complain (Reason : String; Number : Natural; Rest : String) is
      About : Image;
      First : Positive;
   begin
      Format (Number, About, First);
      Complain (Reason, About (First .. Digit_Limit), Rest);
   end Complain;

end Ravenchart.Can.Driver_Hosts;
