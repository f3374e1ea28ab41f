--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces.C.Strings;
with System;

package body Ravenchart.Hosts.Snapshots
  with SPARK_Mode => Off
--  ASM-002, as in the spec.
is
   use type Ada.Real_Time.Time;
   use type Interfaces.C.int;
   use type Interfaces.C.long;
   use type Interfaces.C.Strings.chars_ptr;
   use type System.Address;

   subtype C_Int is Interfaces.C.int;

   --  The C library

   function C_Get_Environment
     (Name : Interfaces.C.char_array) return Interfaces.C.Strings.chars_ptr
   with Import, Convention => C, External_Name => "getenv";

   function C_Open
     (Path  : Interfaces.C.Strings.chars_ptr;
      Flags : C_Int;
      Mode  : Interfaces.C.unsigned) return C_Int
   with Import, Convention => C_Variadic_2, External_Name => "open";

   function C_Lock
     (File : C_Int; Command : C_Int; Length : Interfaces.C.long) return C_Int
   with Import, Convention => C, External_Name => "lockf";

   function C_Truncate (File : C_Int; Length : Interfaces.C.long) return C_Int
   with Import, Convention => C, External_Name => "ftruncate";

   function C_Write
     (File   : C_Int;
      Data   : System.Address;
      Length : Interfaces.C.size_t;
      Offset : Interfaces.C.long) return Interfaces.C.long
   with Import, Convention => C, External_Name => "pwrite";

   procedure Put_All
   with Import, External_Name => "ravenchart_put_all";
   pragma Weak_External (Put_All);
   --  Reports.Put_All of a generated program, linked by this name. In other
   --  programs its address is null, and snapshots have no counts of processors
   --  before the end.

   --  The numbers of Linux

   Read_Write     : constant C_Int := 8#2#;
   Created        : constant C_Int := 8#100#;
   Try_Lock       : constant C_Int := 2;
   No_File        : constant C_Int := -1;

   --  The records of each element

   subtype Kept_Element is Element_Id range 0 .. 16_383;

   type Summary is record
      Count   : Event_Count := 0;
      At_Time : Long_Long_Integer := 0;
      Value   : Long_Long_Integer := 0;
   end record;

   Summaries : array (Kept_Element, Traces.Trace_Kind) of Summary;

   Values : array (Kept_Element) of Summary;
   --  The same, of recorded values.

   Last_Element : Kept_Element := 0;
   --  The greatest element that has a record.

   --  Texts

   Longest_Line : constant := 160;

   type Kept_Line is record
      Length : Natural range 0 .. Longest_Line := 0;
      Text   : String (1 .. Longest_Line);
   end record;

   type Recent_Count is mod 2 ** 5;

   Recent : array (Recent_Count) of Kept_Line;
   Newest : Recent_Count := 0;
   --  The last transitions and faults, as a ring.

   Head : Kept_Line;
   --  The E line and, behind it, the M line.

   Room : constant := 262_144;

   type Bounded_Text is record
      Length  : Natural range 0 .. Room := 0;
      Missing : Event_Count := 0;
      Text    : String (1 .. Room);
   end record;
   --  Missing counts the lines that found no room.

   Counts : Bounded_Text;
   --  The last N line, and all counts that followed it.

   Snapshot : Bounded_Text;

   Last_Lines : constant := 80;
   --  The room of a snapshot that is reserved for its last three lines.

   --  State

   File     : C_Int := No_File;
   Ended    : Boolean := False;
   Sequence : Event_Count := 0;
   Dropped  : Event_Count := 0;
   --  Counts records of elements beyond the last Kept_Element.

   Next     : Ada.Real_Time.Time := Ada.Real_Time.Time_First;

   Period : constant Ada.Real_Time.Time_Span :=
     Ada.Real_Time.Milliseconds (100);

   procedure Append
     (To      : in out Bounded_Text;
      Text    : String;
      Reserve : Natural := Last_Lines);
   --  Add all of Text, if Reserve then remains free; else count it as missing.

   procedure Note_Record (Text : String);
   --  Text is a T line, or a V line.

   procedure Add (To : in out Kept_Line; Text : String);
   --  Add Text, as far as it fits.

   procedure Add_Number
     (To     : in out Kept_Line;
      Number : Long_Long_Integer;
      Width  : Positive := 1)
   with Pre => Width <= 20;
   --  Add a blank and Number in decimal, with leading zeros up to Width.

   procedure Append_Count
     (Kind : String; Element : Kept_Element; Kept : Summary);
   --  Add the C line of a kind of records of an element, if there were some.

   procedure Write_Snapshot;

   ------------
   -- Append --
   ------------

   procedure Append
     (To      : in out Bounded_Text;
      Text    : String;
      Reserve : Natural := Last_Lines)
   is
   begin
      if Text'Length <= Room - Reserve - To.Length then
         To.Text (To.Length + 1 .. To.Length + Text'Length) := Text;
         To.Length := To.Length + Text'Length;
      else
         To.Missing := To.Missing + 1;
      end if;
   end Append;

   ---------
   -- Add --
   ---------

   procedure Add (To : in out Kept_Line; Text : String) is
      Fits : constant Natural :=
        Natural'Min (Text'Length, Longest_Line - To.Length);
   begin
      To.Text (To.Length + 1 .. To.Length + Fits) :=
        Text (Text'First .. Text'First + Fits - 1);
      To.Length := To.Length + Fits;
   end Add;

   ----------------
   -- Add_Number --
   ----------------

   procedure Add_Number
     (To     : in out Kept_Line;
      Number : Long_Long_Integer;
      Width  : Positive := 1)
   is
      Rest  : Long_Long_Integer := abs Number;
      Digit : String (1 .. 20) := (others => '0');
      First : Positive := Digit'Last + 1;
   begin
      while Rest > 0 or else Digit'Last - First + 1 < Width loop
         First := First - 1;
         Digit (First) :=
           Character'Val (Character'Pos ('0') + Natural (Rest mod 10));
         Rest := Rest / 10;
      end loop;
      Add (To, " ");
      if Number < 0 then
         Add (To, "-");
      end if;
      Add (To, Digit (First .. Digit'Last));
   end Add_Number;

   ----------
   -- Open --
   ----------

   procedure Open is
      Path : constant Interfaces.C.Strings.chars_ptr :=
        C_Get_Environment (Interfaces.C.To_C ("RAVENCHART_MONITOR"));
   begin
      if Path = Interfaces.C.Strings.Null_Ptr then
         return;
      end if;
      File := C_Open (Path, Read_Write + Created, 8#644#);
      if File >= 0 and then C_Lock (File, Try_Lock, 0) /= 0 then
         File := No_File;
         Failures.Put_Error
           ("warning: the file named by RAVENCHART_MONITOR cannot be locked:"
            & " no monitor can watch this run");
      elsif File < 0 or else C_Truncate (File, 0) /= 0 then
         File := No_File;
         Failures.Put_Error
           ("warning: the file named by RAVENCHART_MONITOR cannot be written:"
            & " no monitor can watch this run");
      end if;
   end Open;

   -----------------
   -- Note_Record --
   -----------------

   procedure Note_Record (Text : String) is
      Place : Positive := Text'First + 2;

      procedure Get (Number : out Long_Long_Integer);
      --  Read the number at Place, and move Place behind it and its blank.

      procedure Count (Kept : in out Summary);
      --  Count one more record, and keep it as the last one.

      procedure Get (Number : out Long_Long_Integer) is
         Negative : constant Boolean := Text (Place) = '-';
      begin
         Number := 0;
         if Negative then
            Place := Place + 1;
         end if;
         while Text (Place) in '0' .. '9' loop
            Number := 10 * Number
              + (Character'Pos (Text (Place)) - Character'Pos ('0'));
            Place := Place + 1;
         end loop;
         if Negative then
            Number := -Number;
         end if;
         Place := Place + 1;
      end Get;

      Is_Value : constant Boolean := Text (Text'First) = 'V';

      First   : Positive;
      Kind    : Traces.Trace_Kind := Traces.State;
      At_Time : Long_Long_Integer;
      Element : Long_Long_Integer;
      Value   : Long_Long_Integer;

      procedure Count (Kept : in out Summary) is
      begin
         Kept := (Kept.Count + 1, At_Time, Value);
      end Count;

   begin
      Get (At_Time);
      if not Is_Value then
         First := Place;
         while Text (Place) /= ' ' loop
            Place := Place + 1;
         end loop;
         Kind  := Traces.Trace_Kind'Value (Text (First .. Place - 1));
         Place := Place + 1;
      end if;
      Get (Element);
      Get (Value);
      if Element > Long_Long_Integer (Kept_Element'Last) then
         Dropped := Dropped + 1;
      else
         Last_Element :=
           Kept_Element'Max (Last_Element, Kept_Element (Element));
         if Is_Value then
            Count (Values (Kept_Element (Element)));
         else
            Count (Summaries (Kept_Element (Element), Kind));
         end if;
      end if;
      if Kind in Traces.Transition | Traces.Fault and then not Is_Value then
         Newest := Newest + 1;
         Recent (Newest).Length := Text'Length;
         Recent (Newest).Text (1 .. Text'Length) := Text;
      end if;
   end Note_Record;

   ----------
   -- Note --
   ----------

   procedure Note (Text : String) is
   begin
      if File = No_File then
         return;
      end if;
      case Text (Text'First) is
         when 'T' | 'V' =>
            Note_Record (Text);
         when 'M' =>
            Head.Text (Head.Length + 1 .. Head.Length + Text'Length) := Text;
            Head.Length := Head.Length + Text'Length;
         when 'E' =>
            if Text (Text'First + 1) = ' ' then
               Head.Text (1 .. Text'Length) := Text;
               Head.Length := Text'Length;
            else
               Ended := True;
            end if;
         when others =>
            if Text (Text'First) = 'N' then
               Counts.Length  := 0;
               Counts.Missing := 0;
            end if;
            Append (Counts, Text);
      end case;
   end Note;

   ------------------
   -- Append_Count --
   ------------------

   procedure Append_Count
     (Kind : String; Element : Kept_Element; Kept : Summary)
   is
      Text : Kept_Line;
   begin
      if Kept.Count > 0 then
         Add (Text, "C ");
         Add (Text, Kind);
         Add_Number (Text, Long_Long_Integer (Element));
         Add_Number (Text, Long_Long_Integer (Kept.Count));
         Add_Number (Text, Kept.At_Time);
         Add_Number (Text, Kept.Value);
         Add (Text, (1 => ASCII.LF));
         Append (Snapshot, Text.Text (1 .. Text.Length));
      end if;
   end Append_Count;

   --------------------
   -- Write_Snapshot --
   --------------------

   procedure Write_Snapshot is
      First_Line : constant := 22;
      Text       : Kept_Line;
      Place      : Recent_Count := Newest;
   begin
      Sequence := Sequence + 1;
      Snapshot.Length  := First_Line;
      Snapshot.Missing := Counts.Missing;
      Append (Snapshot, Head.Text (1 .. Head.Length));
      for Unused in Recent_Count loop
         Place := Place + 1;  --  from the oldest line on
         Append (Snapshot, Recent (Place).Text (1 .. Recent (Place).Length));
      end loop;
      Append (Snapshot, Counts.Text (1 .. Counts.Length));
      for Element in 1 .. Last_Element loop
         for Kind in Traces.Trace_Kind loop
            Append_Count (Kind'Image, Element, Summaries (Element, Kind));
         end loop;
         Append_Count ("VALUE", Element, Values (Element));
      end loop;
      Text.Length := 0;
      Add (Text, "L snapshot");
      Add_Number (Text, Long_Long_Integer (Dropped + Snapshot.Missing));
      Add (Text, (1 => ASCII.LF));
      if Ended then
         Add (Text, "END");
         Add (Text, (1 => ASCII.LF));
      end if;
      Add (Text, "S");
      Add_Number (Text, Long_Long_Integer (Sequence), Width => 10);
      Add (Text, (1 => ASCII.LF));
      Append (Snapshot, Text.Text (1 .. Text.Length), Reserve => 0);
      Text.Length := 0;
      Add (Text, "S");
      Add_Number (Text, Long_Long_Integer (Sequence), Width => 10);
      Add_Number (Text, Long_Long_Integer (Snapshot.Length), Width => 8);
      Add (Text, (1 => ASCII.LF));
      Snapshot.Text (1 .. First_Line) := Text.Text (1 .. First_Line);
      if C_Write
           (File,
            Snapshot.Text'Address,
            Interfaces.C.size_t (Snapshot.Length),
            0)
        /= Interfaces.C.long (Snapshot.Length)
      then
         File := No_File;
         Failures.Put_Error
           ("warning: the file named by RAVENCHART_MONITOR cannot be written:"
            & " no monitor can watch this run any longer");
      end if;
   end Write_Snapshot;

   -------------
   -- Refresh --
   -------------

   procedure Refresh is
      Now : constant Ada.Real_Time.Time := Ada.Real_Time.Clock;
   begin
      if File /= No_File and then Now >= Next then
         Next := Now + Period;
         if Put_All'Address /= System.Null_Address then
            Put_All;
         else
            Put_Now;
         end if;
         Write_Snapshot;
      end if;
   end Refresh;

   -----------
   -- Close --
   -----------

   procedure Close is
   begin
      if File /= No_File then
         Write_Snapshot;
      end if;
   end Close;

end Ravenchart.Hosts.Snapshots;
