--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Hosts.Services;

package body Ravenchart.Hosts
  with
    SPARK_Mode,
    Refined_State => (Process => Services.State)
is
   use type Ada.Real_Time.Time;

   subtype Line_Length is Natural range 0 .. 160;

   type Line is record
      Length : Line_Length := 0;
      Text   : String (1 .. Line_Length'Last) := (others => ' ');
   end record;
   --  A line of the report; the longest one fits.

   procedure Append (To : in out Line; C : Character)
   with Global => null;
   --  Add C, where there is room.

   procedure Add (To : in out Line; Word : String)
   with Global => null;
   --  Add Word without its blanks, and a blank between two words.

   procedure Add (To : in out Line; Number : Long_Long_Integer)
   with Global => null;
   --  Add Number in decimal.

   procedure Add_Literal (To : in out Line; Image : String)
   with Global => null;
   --  Add the image of an enumeration literal, as the sources spell it.

   procedure Put (Text : Line)
   with Global => (In_Out => Services.State);
   --  Add a line to the report.

   type Number_List is array (Positive range <>) of Long_Long_Integer;

   procedure Put (Kind : String; Numbers : Number_List)
   with Global => (In_Out => Services.State);
   --  Add a line of that kind to the report.

   ------------
   -- Append --
   ------------

   procedure Append (To : in out Line; C : Character) is
   begin
      if To.Length < Line_Length'Last then
         To.Length := To.Length + 1;
         To.Text (To.Length) := C;
      end if;
   end Append;

   ---------
   -- Add --
   ---------

   procedure Add (To : in out Line; Word : String) is
   begin
      if To.Length > 0 then
         Append (To, ' ');
      end if;
      for C of Word loop
         if C /= ' ' then
            Append (To, C);
         end if;
      end loop;
   end Add;

   procedure Add (To : in out Line; Number : Long_Long_Integer) is
   begin
      Add (To, Number'Image);
   end Add;

   -----------------
   -- Add_Literal --
   -----------------

   procedure Add_Literal (To : in out Line; Image : String) is
      Inside : Boolean := False;
   begin
      Append (To, ' ');
      for C of Image loop
         Append
           (To,
            (if Inside and then C in 'A' .. 'Z'
             then Character'Val
               (Character'Pos (C) + Character'Pos ('a') - Character'Pos ('A'))
             else C));
         Inside := C /= '_';
      end loop;
   end Add_Literal;

   ---------
   -- Put --
   ---------

   procedure Put (Text : Line) is
      Ended : Line := Text;
   begin
      Append (Ended, ASCII.LF);
      Services.Put (Ended.Text (1 .. Ended.Length));
   end Put;

   procedure Put (Kind : String; Numbers : Number_List) is
      Text : Line;
   begin
      Add (Text, Kind);
      for Number of Numbers loop
         Add (Text, Number);
      end loop;
      Put (Text);
   end Put;

   -----------
   -- Start --
   -----------

   procedure Start
   with Refined_Global => (Input => Epochs.Start, In_Out => Services.State)
   is
      Zero : constant Ada.Real_Time.Time :=
        Ada.Real_Time.Time_Of (0, Ada.Real_Time.Time_Span_Zero);
   begin
      Services.Start;
      Put ("E", (1 => Long_Long_Integer
                        (Epochs.To_Nanoseconds (Epochs.Start - Zero))));
   end Start;

   --------------------
   -- Stop_Requested --
   --------------------

   function Stop_Requested return Boolean
   with Refined_Global => (Services.State, Failures.State)
   is
      Asked  : constant Boolean := Services.Stop_Requested;
      Failed : constant Boolean := Failures.Stop_Needed;
   begin
      return Asked or else Failed;
   end Stop_Requested;

   ---------------
   -- Put_Model --
   ---------------

   procedure Put_Model (Digest : String)
   with Refined_Global => (In_Out => Services.State)
   is
      Text : Line;
   begin
      Add (Text, "M");
      Add (Text, Digest);
      Put (Text);
   end Put_Model;

   ---------------
   -- Put_Trace --
   ---------------

   procedure Put_Trace (Item : Traces.Trace_Record)
   with Refined_Global => (In_Out => Services.State)
   is
      Text : Line;
   begin
      Add (Text, "T");
      Add (Text, Long_Long_Integer (Item.At_Time));
      Add_Literal (Text, Item.Kind'Image);
      Add (Text, Long_Long_Integer (Item.Element));
      Add (Text, Long_Long_Integer (Item.Value));
      Put (Text);
   end Put_Trace;

   -------------------
   -- Put_Processor --
   -------------------

   procedure Put_Processor
     (Id             : Element_Id;
      Releases       : Event_Count;
      Misses         : Event_Count;
      Worst_Response : Nanoseconds;
      Last_Response  : Nanoseconds)
   with Refined_Global => (In_Out => Services.State)
   is
   begin
      Put
        ("P",
         (Long_Long_Integer (Id),
          Long_Long_Integer (Releases),
          Long_Long_Integer (Misses),
          Long_Long_Integer (Worst_Response),
          Long_Long_Integer (Last_Response)));
   end Put_Processor;

   ---------------
   -- Put_Queue --
   ---------------

   procedure Put_Queue (Id : Element_Id; Found : Queueing.Fill)
   with Refined_Global => (In_Out => Services.State)
   is
   begin
      Put
        ("Q",
         (Long_Long_Integer (Id),
          Long_Long_Integer (Found.Now),
          Long_Long_Integer (Found.Highest)));
   end Put_Queue;

   ------------------
   -- Put_Activity --
   ------------------

   procedure Put_Activity (Id : Element_Id; Worst_Execution : Nanoseconds)
   with Refined_Global => (In_Out => Services.State)
   is
   begin
      Put
        ("A",
         (Long_Long_Integer (Id),
          Long_Long_Integer (Worst_Execution)));
   end Put_Activity;

   ---------------------
   -- Put_Fault_Count --
   ---------------------

   procedure Put_Fault_Count (Kind : Health.Fault_Kind; Count : Event_Count)
   with Refined_Global => (In_Out => Services.State)
   is
      Text : Line;
   begin
      Add (Text, "H");
      Add_Literal (Text, Kind'Image);
      Add (Text, Long_Long_Integer (Count));
      Put (Text);
   end Put_Fault_Count;

   --------------
   -- Put_Lost --
   --------------

   procedure Put_Lost (What : String; Count : Event_Count)
   with Refined_Global => (In_Out => Services.State)
   is
      Text : Line;
   begin
      Add (Text, "L");
      Add (Text, What);
      Add (Text, Long_Long_Integer (Count));
      Put (Text);
   end Put_Lost;

   ----------------------
   -- Put_Host_Latency --
   ----------------------

   procedure Put_Host_Latency (Longest : Nanoseconds)
   with Refined_Global => (In_Out => Services.State)
   is
   begin
      Put ("W", (1 => Long_Long_Integer (Longest)));
   end Put_Host_Latency;

   --------------------
   -- Put_Other_Core --
   --------------------

   procedure Put_Other_Core (Looked : Nanoseconds)
   with Refined_Global => (In_Out => Services.State)
   is
   begin
      Put ("O", (1 => Long_Long_Integer (Looked)));
   end Put_Other_Core;

   -------------
   -- Put_Now --
   -------------

   procedure Put_Now
   with
     Refined_Global =>
       (Input  => (Epochs.Start, Ada.Real_Time.Clock_Time),
        In_Out => Services.State)
   is
      Now  : Nanoseconds;
   begin
      Epochs.Since_Start (Now);
      Put ("N", (1 => Long_Long_Integer (Now)));
   end Put_Now;

   ---------------
   -- Put_Feeds --
   ---------------

   procedure Put_Feeds (Count : Event_Count)
   with Refined_Global => (In_Out => Services.State)
   is
   begin
      Put ("F", (1 => Long_Long_Integer (Count)));
   end Put_Feeds;

   ------------
   -- Finish --
   ------------

   procedure Finish (Success : Boolean)
   with Refined_Global => (In_Out => (Services.State, Failures.State))
   is
      Failed : constant Boolean := Failures.Stop_Needed;
      Text   : Line;
   begin
      Add (Text, "END");
      Put (Text);
      Services.Flush;
      Failures.Put_Reasons;
      Services.Finish (Success and then not Failed);
   end Finish;

end Ravenchart.Hosts;
