--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with GNAT.OS_Lib;

package body Files is
   use GNAT.OS_Lib;

   function Process_Id return Integer
   with Import, Convention => C, External_Name => "getpid";

   function Besides (Path : String) return String is
     (Path & "." & Integer'Image (-Process_Id));
   --  A name that no other process takes.

   function Digits_Of (Value, Count : Natural) return String;

   ----------
   -- Copy --
   ----------

   procedure Copy (From, To : String) is
      Done : Boolean;
   begin
      Copy_File
        (From, Besides (To), Done, Mode => Overwrite, Preserve => None);
      if Done then
         Rename_File (Besides (To), To, Done);
      end if;
      if not Done then
         raise Not_There with From;
      end if;
   end Copy;

   ---------------
   -- Digits_Of --
   ---------------

   function Digits_Of (Value, Count : Natural) return String is
      Image : constant String := Integer'Image (10 ** Count + Value);
   begin
      return Image (Image'Last - Count + 1 .. Image'Last);
   end Digits_Of;

   --------------
   -- Lines_Of --
   --------------

   function Lines_Of (Path : String) return Line_List is
      Text  : constant String := Text_Of (Path);
      First : Positive := Text'First;
   begin
      return Found : Line_List do
         for I in Text'Range loop
            if Text (I) = ASCII.LF then
               Found.Append (Text (First .. I - 1));
               First := I + 1;
            end if;
         end loop;
         if First <= Text'Last then
            Found.Append (Text (First .. Text'Last));
         end if;
      end return;
   end Lines_Of;

   -------------
   -- Text_Of --
   -------------

   function Text_Of (Path : String) return String is
      File : constant File_Descriptor := Open_Read (Path, Binary);
   begin
      if File = Invalid_FD then
         raise Not_There with Path;
      end if;
      return Text : String (1 .. Integer (File_Length (File))) do
         if Read (File, Text'Address, Text'Length) /= Text'Length then
            raise Not_There with Path;
         end if;
         Close (File);
      end return;
   end Text_Of;

   -------------
   -- Time_Of --
   -------------

   function Time_Of (Path : String) return String is
      Year   : Year_Type;
      Month  : Month_Type;
      Day    : Day_Type;
      Hour   : Hour_Type;
      Minute : Minute_Type;
      Second : Second_Type;
   begin
      GM_Split
        (File_Time_Stamp (Path), Year, Month, Day, Hour, Minute, Second);
      return Digits_Of (Year, 4) & Digits_Of (Month, 2) & Digits_Of (Day, 2)
        & Digits_Of (Hour, 2) & Digits_Of (Minute, 2) & Digits_Of (Second, 2);
   end Time_Of;

   -----------
   -- Touch --
   -----------

   procedure Touch (Path : String) is
   begin
      Set_File_Last_Modify_Time_Stamp (Path, Current_Time);
   end Touch;

   -----------
   -- Write --
   -----------

   procedure Write (Path, Text : String) is
      File : constant File_Descriptor := Create_File (Besides (Path), Binary);
      Done : Boolean := File /= Invalid_FD;
   begin
      if Done then
         Done := Write (File, Text'Address, Text'Length) = Text'Length;
         Close (File);
      end if;
      if Done then
         Rename_File (Besides (Path), Path, Done);
      end if;
      if not Done then
         raise Not_There with Path;
      end if;
   end Write;

end Files;
