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

   type Bus_Flags is array (Bus_Place) of Boolean
   with Atomic_Components;

   Complained : Bus_Flags := (others => False);
   --  The drivers retry; one message of each bus is enough.

   procedure Print
     (File : C_Int; Head, Text, About : String; Rest : String := "");
   --  Write the parts and the end of a line to File, unbuffered.

   Digit_Limit : constant := 10;
   --  The digits of a Natural.

   subtype Image is String (1 .. Digit_Limit);

   function Found
     (Name, Bus_Name : String) return Interfaces.C.Strings.chars_ptr;
   --  The value of an environment variable of a bus, or of all where its name
   --  is empty; Null_Ptr without it.

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

   -----------
   -- Found --
   -----------

   function Found
     (Name, Bus_Name : String) return Interfaces.C.Strings.chars_ptr
   is
      use type Interfaces.C.size_t;

      Variable : Interfaces.C.char_array (1 .. Text_Limit) :=
        (others => Interfaces.C.nul);
      Last     : Interfaces.C.size_t := 0;

      procedure Add (Part : String);
      --  Append Part.

      procedure Add (Part : String) is
      begin
         for C of Part loop
            Last            := Last + 1;
            Variable (Last) := Interfaces.C.To_C (C);
         end loop;
      end Add;
   begin
      Add (Name);
      if Bus_Name /= "" then
         Add ("_");
         Add (Bus_Name);
      end if;
      return C_Get_Environment (Variable);
   end Found;

   ------------------
   -- Read_Setting --
   ------------------

   procedure Read_Setting
     (Name, Bus_Name : String; Text : out String; Last : out Natural)
   is
      use Interfaces.C.Strings;
      Own : constant chars_ptr := Found (Name, Bus_Name);
      Set : constant chars_ptr :=
        (if Own = Null_Ptr then Found (Name, "") else Own);
   begin
      Text := (others => ' ');
      Last := 0;
      if Set /= Null_Ptr then
         declare
            Content : constant String := Value (Set, Text'Length);
         begin
            Last := Content'Length;
            Text (1 .. Last) := Content;
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
     (Bus    : Bus_Place;
      Reason : String;
      About  : String := "";
      Rest   : String := "") is
   begin
      if not Complained (Bus) then
         Complained (Bus) := True;
         Print (Standard_Error, "error: can: ", Reason, About, Rest);
      end if;
   end Complain;

   procedure Complain
     (Bus : Bus_Place; Reason : String; Number : Natural; Rest : String)
   is
      About : Image;
      First : Positive;
   begin
      Format (Number, About, First);
      Complain (Bus, Reason, About (First .. Digit_Limit), Rest);
   end Complain;

end Ravenchart.Can.Driver_Hosts;
