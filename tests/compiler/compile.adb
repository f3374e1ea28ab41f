--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Stands for gcc where the tests build: a unit that was compiled before, from
--  the same text and with the same options, is copied from a store.
--
--  Beside this program are the folder "store" and the file "compiler", whose
--  lines are the path of gcc, the folder of GNAT's library and the version.
--  A result is stored under a digest of all that is known before compilation:
--  the compiler, the options, the configuration pragmas, the names of the
--  project's files and the text of the unit. With each result the store has
--  the digests of the files that the compiler read, which its ALI file names:
--  they must be the same. A compilation that prints anything is not stored,
--  and a call with an option that is not known here goes to gcc.

with Ada.Command_Line;
with Ada.Containers.Indefinite_Ordered_Maps;
with Ada.Containers.Indefinite_Ordered_Sets;
with Ada.Directories;
with Ada.Strings.Fixed;
with Ada.Strings.Maps;
with Ada.Strings.Unbounded;
with Ada.Text_IO;
with Files;
with GNAT.OS_Lib;
with GNAT.SHA256;

procedure Compile is
   use Ada.Directories;
   use Ada.Strings.Fixed;
   use Ada.Strings.Unbounded;
   use type GNAT.OS_Lib.File_Descriptor;

   package Maps is new Ada.Containers.Indefinite_Ordered_Maps
     (Key_Type => String, Element_Type => String);

   package Sets is new Ada.Containers.Indefinite_Ordered_Sets (String);

   Home : constant String :=
     Containing_Directory (Ada.Command_Line.Command_Name) & "/";

   Settings : constant Files.Line_List := Files.Lines_Of (Home & "compiler");
   Gcc      : constant String := Settings (1);
   Library  : constant String := Settings (2) & "/";

   White : constant Ada.Strings.Maps.Character_Set :=
     Ada.Strings.Maps.To_Set (' ' & ASCII.HT);

   Sources  : Natural := 0;
   Compiles : Boolean := False;
   Is_Known : Boolean := True;
   --  Of this call: its source files, has it -c, is each option known here?

   Source  : Unbounded_String;
   Object  : Unbounded_String;
   Before  : Unbounded_String;
   --  All that is known before compilation.

   Project : Maps.Map;
   --  The paths of the project's files by their names.
   Pragmas : Maps.Map;
   --  Those of files of configuration pragmas.
   Folders : Files.Line_List;
   --  Where other files are.

   function Starts (Text, Start : String) return Boolean is
     (Text'Length > Start'Length and then Head (Text, Start'Length) = Start);

   procedure Read_Call;
   procedure Read_Option (Option : String);
   procedure Read_Mapping (Path : String);

   function Located (Name : String) return String;
   --  The path of a file that an ALI file names; "" where it is nowhere but in
   --  the library.

   function Digest_Of (Name : String) return String;
   --  Of the text of such a file; "" where it is nowhere.

   function Name_In (Line : String) return String;
   --  The name in such a line of an ALI file; "" in another line.

   function Is_Up_To_Date (Result : String) return Boolean;
   --  Has each file the digest that it had when this result was stored?

   function Dated (Line : String) return String;
   --  A line of an ALI file for the path and the time that a file has now.

   function Has_Restored (Folder : String) return Boolean;
   --  The object, from the first result in the folder that is up to date.

   procedure Compile_And_Store (Folder : String);

   procedure Restore (Result : String);

   procedure Store (Folder : String);
   --  What the compiler has made.

   function Called (Output : String) return Integer;
   --  The status of gcc; what it prints goes to that file, if it is not "".

   function Ali return String is
     (Head (To_String (Object), Length (Object) - 1) & "ali");
   --  The path of the ALI file.

   function Graph return String is
     (Head (To_String (Object), Length (Object) - 1) & "ci");
   --  The path of the call graph, which an option asks for. In one that was
   --  stored, files are where they were compiled first.

   ------------
   -- Called --
   ------------

   function Called (Output : String) return Integer is
      use GNAT.OS_Lib;
      Words  : Argument_List (1 .. Ada.Command_Line.Argument_Count);
      File   : File_Descriptor;
      Status : Integer;
   begin
      for I in Words'Range loop
         Words (I) := new String'(Ada.Command_Line.Argument (I));
      end loop;
      if Output = "" then
         return Spawn (Gcc, Words);
      end if;
      File := Create_File (Output, Binary);
      Spawn (Gcc, Words, File, Status, Err_To_Out => True);
      Close (File);
      return Status;
   end Called;

   -----------------------
   -- Compile_And_Store --
   -----------------------

   procedure Compile_And_Store (Folder : String) is
      Output : constant String := To_String (Object) & ".output";
      Status : constant Integer := Called (Output);
      Said   : constant String := Files.Text_Of (Output);
   begin
      Delete_File (Output);
      if Said /= "" then
         Ada.Text_IO.Put (Ada.Text_IO.Standard_Error, Said);
      elsif Status = 0 then
         Store (Folder);
      end if;
      Ada.Command_Line.Set_Exit_Status
        (Ada.Command_Line.Exit_Status (Status));
   end Compile_And_Store;

   -----------
   -- Dated --
   -----------

   function Dated (Line : String) return String is
      Name : constant String := Name_In (Line);
      Path : constant String := (if Name = "" then "" else Located (Name));
      Rest : constant Positive := Line'First + 2 + Name'Length;
      Time : Natural;
   begin
      if Path = "" then
         return Line;
      end if;
      Time := Index (Line, White, Rest, Test => Ada.Strings.Outside);
      return "D "
        & (if not Starts (Name, "/") then Name
           elsif Index (Path, " ") = 0 then Path
           else '"' & Path & '"')
        & Line (Rest .. Time - 1) & Files.Time_Of (Path)
        & Line (Time + 14 .. Line'Last);
   end Dated;

   ---------------
   -- Digest_Of --
   ---------------

   function Digest_Of (Name : String) return String is
      Path : constant String := Located (Name);
   begin
      if Path /= "" then
         return GNAT.SHA256.Digest (Files.Text_Of (Path));
      elsif Exists (Library & Name) then
         return "library";
      else
         return "";
      end if;
   end Digest_Of;

   ------------------
   -- Has_Restored --
   ------------------

   function Has_Restored (Folder : String) return Boolean is
      Search : Search_Type;
      Found  : Directory_Entry_Type;
   begin
      if not Exists (Folder) then
         return False;
      end if;
      Start_Search
        (Search, Folder, "*.read", (Ordinary_File => True, others => False));
      while More_Entries (Search) loop
         Get_Next_Entry (Search, Found);
         if Is_Up_To_Date (Full_Name (Found)) then
            Restore (Folder & "/" & Base_Name (Full_Name (Found)));
            return True;
         end if;
      end loop;
      return False;
   end Has_Restored;

   -------------------
   -- Is_Up_To_Date --
   -------------------

   function Is_Up_To_Date (Result : String) return Boolean is
   begin
      for Line of Files.Lines_Of (Result) loop
         declare
            Cut : constant Positive := Index (Line, "=");
         begin
            if Digest_Of (Line (Cut + 1 .. Line'Last))
              /= Line (Line'First .. Cut - 1)
            then
               return False;
            end if;
         end;
      end loop;
      return True;
   end Is_Up_To_Date;

   -------------
   -- Located --
   -------------

   function Located (Name : String) return String is
   begin
      if Starts (Name, "/") then
         return
           (if Pragmas.Contains (Simple_Name (Name))
            then Pragmas (Simple_Name (Name)) else "");
      elsif Project.Contains (Name) then
         return Project (Name);
      end if;
      for Folder of Folders loop
         if Exists (Folder & "/" & Name) then
            return Folder & "/" & Name;
         end if;
      end loop;
      return "";
   end Located;

   -------------
   -- Name_In --
   -------------

   function Name_In (Line : String) return String is
   begin
      if not Starts (Line, "D ") then
         return "";
      end if;
      return Line
        (Line'First + 2 .. Index (Line, White, Line'First + 2) - 1);
   end Name_In;

   ---------------
   -- Read_Call --
   ---------------

   procedure Read_Call is
      Count : constant Natural := Ada.Command_Line.Argument_Count;
      Names : Sets.Set;
      I     : Positive := 1;
   begin
      Append (Before, Files.Text_Of (Home & "compiler"));
      while I <= Count loop
         if Ada.Command_Line.Argument (I) = "-o" and then I < Count then
            Object := To_Unbounded_String (Ada.Command_Line.Argument (I + 1));
            I := I + 1;
         else
            Read_Option (Ada.Command_Line.Argument (I));
         end if;
         I := I + 1;
      end loop;
      if Sources /= 1 then
         return;
      end if;
      declare
         Path : constant String := To_String (Source);
      begin
         Folders.Prepend (Containing_Directory (Path));
         if Length (Object) = 0 then
            Object := To_Unbounded_String (Base_Name (Path) & ".o");
         end if;
         Append (Before, Simple_Name (Path) & ASCII.LF & Files.Text_Of (Path));
      end;
      for Position in Project.Iterate loop
         Names.Include (Maps.Key (Position));
      end loop;
      for Name of Names loop
         Append (Before, Name & ASCII.LF);
      end loop;
   end Read_Call;

   ------------------
   -- Read_Mapping --
   ------------------

   procedure Read_Mapping (Path : String) is
      Lines : constant Files.Line_List := Files.Lines_Of (Path);
   begin
      for I in 1 .. Natural (Lines.Length) / 3 loop
         if not Starts (Lines (3 * I), Library) then
            Project.Include (Lines (3 * I - 1), Lines (3 * I));
         end if;
      end loop;
   end Read_Mapping;

   -----------------
   -- Read_Option --
   -----------------

   procedure Read_Option (Option : String) is
      Given : constant Natural := Index (Option, "=");
   begin
      if Starts (Option, "-gnatem=") then
         Read_Mapping (Option (Given + 1 .. Option'Last));
         return;
      elsif Starts (Option, "-gnatec=") then
         declare
            Path : constant String := Option (Given + 1 .. Option'Last);
         begin
            Pragmas.Include (Simple_Name (Path), Path);
            Append (Before, Files.Text_Of (Path) & ASCII.LF);
         end;
         return;
      elsif Starts (Option, "-I") or else Starts (Option, "-aI") then
         if Option /= "-I-" then
            Folders.Append
              (Option (Index (Option, "I") + 1 .. Option'Last));
         end if;
         return;
      elsif Option (Option'First) = '-' or else Option = "ada" then
         Compiles := Compiles or else Option = "-c";
         Is_Known := Is_Known and then not Starts (Option, "-gnatep");
      elsif Extension (Option) in "adb" | "ads" then
         Sources := Sources + 1;
         Source := To_Unbounded_String (Option);
         return;
      else
         Is_Known := False;
      end if;
      Append (Before, Option & ASCII.LF);
   end Read_Option;

   -------------
   -- Restore --
   -------------

   procedure Restore (Result : String) is
      Text : Unbounded_String;
   begin
      for Line of Files.Lines_Of (Result & ".ali") loop
         Append (Text, Dated (Line) & ASCII.LF);
      end loop;
      Files.Write (Ali, To_String (Text));
      Files.Copy (Result & ".o", To_String (Object));
      if Exists (Result & ".ci") then
         Files.Copy (Result & ".ci", Graph);
      end if;
      Files.Touch (Result & ".read");
   end Restore;

   -----------
   -- Store --
   -----------

   procedure Store (Folder : String) is
      Read : Unbounded_String;
   begin
      for Line of Files.Lines_Of (Ali) loop
         declare
            Name : constant String := Name_In (Line);
         begin
            if Name /= "" then
               if Digest_Of (Name) = "" then
                  return;
               end if;
               Append (Read, Digest_Of (Name) & "=" & Name & ASCII.LF);
            end if;
         end;
      end loop;
      Create_Path (Folder);
      declare
         Result : constant String :=
           Folder & "/" & GNAT.SHA256.Digest (To_String (Read));
      begin
         Files.Copy (Ali, Result & ".ali");
         Files.Copy (To_String (Object), Result & ".o");
         if Exists (Graph) then
            Files.Copy (Graph, Result & ".ci");
         end if;
         Files.Write (Result & ".read", To_String (Read));
      end;
   end Store;

   Key : Unbounded_String;
begin
   Read_Call;
   if not Compiles or else Sources /= 1 or else not Is_Known then
      Ada.Command_Line.Set_Exit_Status
        (Ada.Command_Line.Exit_Status (Called (Output => "")));
      return;
   end if;
   Key := To_Unbounded_String (GNAT.SHA256.Digest (To_String (Before)));
   if not Has_Restored (Home & "store/" & To_String (Key)) then
      Compile_And_Store (Home & "store/" & To_String (Key));
   end if;
end Compile;
