--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Command_Line;
with Ada.Strings.Unbounded;
with Ada.Text_IO;
with Interfaces;
with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Bus_Names;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Bus_Records;
with Ravenchart.Can.Line_Events;
with Ravenchart.Can.Transmit_Buffers;

package body Bus_Options is

   use Ravenchart;
   use Ravenchart.Can;

   Second : constant := 1_000_000_000;

   Paced : Boolean := True;

   Log : Ada.Strings.Unbounded.Unbounded_String;

   subtype Thousandths is Nanoseconds range 0 .. 1_000;

   Nominal_Sample : Thousandths := 800;
   Data_Sample    : Thousandths := 800;

   function Part (Text : String; Number : Positive) return String;
   --  Part Number of the text between the colons, from 1; "0" where it is
   --  empty.

   function Rate (Text : String) return Bus_Records.Bit_Rate;
   --  A bit rate whose bit time is a number of nanoseconds.

   procedure Set (Name, Value : String; Port : in out Natural);
   --  Read one word of the command line.

   procedure Add_Fault (Value : String);

   procedure Add_Event (Value : String);

   --------------
   -- Is_Paced --
   --------------

   function Is_Paced return Boolean
   is (Paced);

   --------------
   -- Log_File --
   --------------

   function Log_File return String
   is (Ada.Strings.Unbounded.To_String (Log));

   ----------
   -- Part --
   ----------

   function Part (Text : String; Number : Positive) return String is
      First : Positive := Text'First;
      Left  : Positive := Number;
   begin
      for I in Text'Range loop
         if Text (I) = ':' then
            if Left = 1 then
               return Text (First .. I - 1);
            end if;
            Left  := Left - 1;
            First := I + 1;
         end if;
      end loop;
      return (if Left = 1 then Text (First .. Text'Last) else "0");
   end Part;

   ----------
   -- Rate --
   ----------

   function Rate (Text : String) return Bus_Records.Bit_Rate is
      Result : constant Natural := Natural'Value (Text);
   begin
      if Result > 0 and then Second mod Result /= 0 then
         raise Constraint_Error;
      end if;
      return Bus_Records.Bit_Rate (Result);
   end Rate;

   ---------------
   -- Add_Fault --
   ---------------

   procedure Add_Fault (Value : String) is
      use all type Bus_Faults.Fault_Kind;
      Kind   : constant Bus_Faults.Fault_Kind :=
        Bus_Faults.Fault_Kind'Value (Part (Value, 2));
      Result : Bus_Faults.Fault :=
        (Kind   => Kind,
         Node   => Natural'Value (Part (Value, 3)),
         others => <>);
      Figure : String renames Part (Value, 4);
   begin
      case Kind is
         when Disturbed_Bit | Overload =>
            Result.Position := Positive'Value (Figure);
         when Disturbed_End =>
            Result.Position := Positive'Value (Figure);
            if Result.Position > 10
              or else (Result.Position = 10
                       and then Result.Node /= Bus_Faults.Everyone)
            then
               raise Constraint_Error;
            end if;
         when Delayed       =>
            Result.Late := Nanoseconds'Value (Figure);
         when Corrupted     =>
            Result.Index := Natural'Value (Figure);
            Result.Mask  := Interfaces.Unsigned_8'Value (Part (Value, 5));
         when others        =>
            null;
      end case;
      Bus.Plan.Count := Bus.Plan.Count + 1;
      Bus.Plan.Listed (Bus.Plan.Count) :=
        (Frame => Event_Count'Value (Part (Value, 1)), Fault => Result);
   end Add_Fault;

   ---------------
   -- Add_Event --
   ---------------

   procedure Add_Event (Value : String) is
      Kind  : constant Line_Events.Event_Kind :=
        Line_Events.Event_Kind'Value (Part (Value, 2));
      Start : constant Nanoseconds := Nanoseconds'Value (Part (Value, 1));
      Node  : constant Natural := Natural'Value (Part (Value, 3));
   begin
      if Bus.Agenda.Count > 0
        and then Bus.Agenda.Events (Bus.Agenda.Count).Start > Start
      then
         raise Constraint_Error;
      end if;
      Bus.Agenda.Count := Bus.Agenda.Count + 1;
      Bus.Agenda.Events (Bus.Agenda.Count) :=
        (Kind  => Kind,
         Start => Start,
         Node  => Bus_Nodes.Node_Index (if Node = 0 then 1 else Node),
         Frame =>
           (Family => Bus_Frames.Classic,
            Plain  =>
              Data_Frame
                (Standard_Identifier'Value (Part (Value, 4)),
                 Ravenchart.Can.Standard, 8, 0)));
   end Add_Event;

   ---------
   -- Set --
   ---------

   procedure Set (Name, Value : String; Port : in out Natural) is
   begin
      if Name = "port" then
         Port := Natural'Value (Value);
         if Port > 65_535 then
            raise Constraint_Error;
         end if;
      elsif Name = "name" and then Bus_Records.Is_Name (Value) then
         Bus.Profile.Name := Bus_Names.Named (Value);
      elsif Name = "bitrate" then
         Bus.Profile.Nominal := Rate (Value);
      elsif Name = "data_bitrate" then
         Bus.Profile.Data := Rate (Value);
      elsif Name = "sample_point" then
         Nominal_Sample := Nanoseconds'Value (Value);
      elsif Name = "data_sample_point" then
         Data_Sample := Nanoseconds'Value (Value);
      elsif Name = "restart_ms" then
         Bus.Profile.Restart := Nanoseconds'Value (Value) * 1_000_000;
      elsif Name = "time" and then Value in "paced" | "virtual" then
         Paced := Value = "paced";
      elsif Name = "buffer" and then Value in "fifo" | "priority" then
         for B of Bus.Net.Buffers loop
            Transmit_Buffers.Reset
              (B,
               (if Value = "fifo"
                then Transmit_Buffers.First_In_First_Out
                else Transmit_Buffers.By_Priority));
         end loop;
      elsif Name = "seed" then
         Bus.Plan.Seed :=
           Interfaces.Unsigned_32'Value (Part (Value, 1));
         Bus.Plan.Separation := Nanoseconds'Value (Part (Value, 2));
      elsif Name = "log" then
         Log := Ada.Strings.Unbounded.To_Unbounded_String (Value);
         Bus.Log.Kept := True;
      elsif Name = "fault" then
         Add_Fault (Value);
      elsif Name = "event" then
         Add_Event (Value);
      else
         raise Constraint_Error;
      end if;
   end Set;

   ----------
   -- Read --
   ----------

   procedure Read (Port : out Natural) is
      use type Bus_Records.Bit_Rate;
   begin
      Port := 29_536;
      Bus.Profile.Name := Bus_Names.Named ("can0");
      for I in 1 .. Ada.Command_Line.Argument_Count loop
         declare
            Word  : constant String := Ada.Command_Line.Argument (I);
            Equal : Natural := Word'First;
         begin
            while Equal < Word'Last and then Word (Equal) /= '=' loop
               Equal := Equal + 1;
            end loop;
            Set
              (Word (Word'First .. Equal - 1),
               Word (Equal + 1 .. Word'Last), Port);
         exception
            when Constraint_Error =>
               Ada.Text_IO.Put_Line
                 (Ada.Text_IO.Standard_Error,
                  "error: the bus does not accept " & Word);
               raise Wrong;
         end;
      end loop;
      Bus.Net.Bus.Times.Nominal :=
        Second / Nanoseconds (Bus.Profile.Nominal);
      if Bus.Profile.Data > 0 then
         Bus.Net.Bus.Times.Data := Second / Nanoseconds (Bus.Profile.Data);
         Bus.Net.Bus.Times.Switch :=
           Nanoseconds'Max
             (0,
              (Bus.Net.Bus.Times.Nominal * Nominal_Sample
               - Bus.Net.Bus.Times.Data * Data_Sample) / 1_000);
      end if;
   end Read;

end Bus_Options;
