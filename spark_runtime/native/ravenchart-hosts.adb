with Interfaces.C.Strings;
with System;

package body Ravenchart.Hosts
  with SPARK_Mode => Off
--  ASM-002. Signals, files and the scheduling policy are reached through the
--  C library, by address; SPARK has no words for a handler that the kernel
--  calls.
is
   use type Interfaces.C.int;
   use type Interfaces.C.long;
   use type Interfaces.C.Strings.chars_ptr;

   subtype C_Int is Interfaces.C.int;

   --  The C library

   type Signal_Handler is access procedure (Signal : C_Int)
   with Convention => C;

   function C_Signal
     (Signal : C_Int; Handler : Signal_Handler) return System.Address
   with Import, Convention => C, External_Name => "signal";

   function C_Ignore
     (Signal : C_Int; Handler : Interfaces.C.long) return System.Address
   with Import, Convention => C, External_Name => "signal";

   function C_Get_Scheduler (Process_Id : C_Int) return C_Int
   with Import, Convention => C, External_Name => "sched_getscheduler";

   function C_Get_Environment
     (Name : Interfaces.C.char_array) return Interfaces.C.Strings.chars_ptr
   with Import, Convention => C, External_Name => "getenv";

   function C_Create
     (Path : Interfaces.C.Strings.chars_ptr; Mode : Interfaces.C.unsigned)
      return C_Int
   with Import, Convention => C, External_Name => "creat";

   function C_Write
     (File : C_Int; Data : System.Address; Length : Interfaces.C.size_t)
      return Interfaces.C.long
   with Import, Convention => C, External_Name => "write";

   function C_Flush (Stream : System.Address) return C_Int
   with Import, Convention => C, External_Name => "fflush";

   procedure C_Exit (Status : C_Int)
   with Import, Convention => C, External_Name => "_exit", No_Return;

   --  The numbers of Linux

   Interrupt_Signal     : constant C_Int := 2;
   Broken_Pipe_Signal   : constant C_Int := 13;
   Terminate_Signal     : constant C_Int := 15;
   File_Too_Long_Signal : constant C_Int := 25;
   Ignore_Signal        : constant Interfaces.C.long := 1;
   Standard_Error       : constant C_Int := 2;
   Fifo_Policy          : constant C_Int := 1;
   No_File              : constant C_Int := -1;

   --  State

   Stop_Flag : Boolean := False
   with Atomic;
   --  Set by the handler, on whichever thread the kernel chose.

   Report_File : C_Int := No_File;
   --  No_File also after a failed write: the report is then cut short.

   subtype Buffer_Length is Natural range 0 .. 16_384;

   Buffer : String (1 .. Buffer_Length'Last);
   Filled : Buffer_Length := 0;

   procedure Request_Stop (Signal : C_Int)
   with Convention => C;
   --  The handler.

   procedure Write_All (File : in out C_Int; Text : String);
   --  Write Text; File becomes No_File when it cannot be written.

   procedure Flush;
   --  Write the buffer out.

   procedure Put_Line (Text : String);
   --  Add a line to the report, if there is one.

   function Image (Value : Long_Long_Integer) return String;
   --  Value in decimal, with no space before it.

   function Capitalized (Name : String) return String;
   --  An enumeration literal as the sources spell it.

   ------------------
   -- Request_Stop --
   ------------------

   procedure Request_Stop (Signal : C_Int) is
      pragma Unreferenced (Signal);
   begin
      Stop_Flag := True;
   end Request_Stop;

   ---------------
   -- Write_All --
   ---------------

   procedure Write_All (File : in out C_Int; Text : String) is
      Written : Natural := 0;
      Result  : Interfaces.C.long;
   begin
      while File /= No_File and then Written < Text'Length loop
         Result := C_Write
           (File,
            Text (Text'First + Written)'Address,
            Interfaces.C.size_t (Text'Length - Written));
         if Result > 0 then
            Written := Written + Natural (Result);
         else
            File := No_File;
         end if;
      end loop;
   end Write_All;

   -----------
   -- Flush --
   -----------

   procedure Flush is
   begin
      Write_All (Report_File, Buffer (1 .. Filled));
      Filled := 0;
   end Flush;

   --------------
   -- Put_Line --
   --------------

   procedure Put_Line (Text : String) is
   begin
      if Report_File /= No_File then
         if Text'Length + 1 > Buffer'Last - Filled then
            Flush;
         end if;
         Buffer (Filled + 1 .. Filled + Text'Length + 1) := Text & ASCII.LF;
         Filled := Filled + Text'Length + 1;
      end if;
   end Put_Line;

   -----------
   -- Image --
   -----------

   function Image (Value : Long_Long_Integer) return String is
      Text : constant String := Value'Image;
   begin
      return
        (if Text (Text'First) = ' '
         then Text (Text'First + 1 .. Text'Last)
         else Text);
   end Image;

   -----------------
   -- Capitalized --
   -----------------

   function Capitalized (Name : String) return String is
      Result : String  := Name;
      Inside : Boolean := False;
   begin
      for C of Result loop
         if Inside and then C in 'A' .. 'Z' then
            C := Character'Val
              (Character'Pos (C) - Character'Pos ('A') + Character'Pos ('a'));
         end if;
         Inside := C /= '_';
      end loop;
      return Result;
   end Capitalized;

   -----------
   -- Start --
   -----------

   procedure Start is
      Ignored : System.Address;
      Whole   : Ada.Real_Time.Seconds_Count;
      Rest    : Ada.Real_Time.Time_Span;
      Path    : constant Interfaces.C.Strings.chars_ptr :=
        C_Get_Environment (Interfaces.C.To_C ("RAVENCHART_TRACE"));
      Stream  : C_Int := Standard_Error;
   begin
      Ignored := C_Signal (Interrupt_Signal, Request_Stop'Access);
      Ignored := C_Signal (Terminate_Signal, Request_Stop'Access);
      Ignored := C_Ignore (Broken_Pipe_Signal, Ignore_Signal);
      Ignored := C_Ignore (File_Too_Long_Signal, Ignore_Signal);
      if Path /= Interfaces.C.Strings.Null_Ptr then
         Report_File := C_Create (Path, 8#644#);
         if Report_File < 0 then
            Report_File := No_File;
            Write_All
              (Stream,
               "warning: the file named by RAVENCHART_TRACE cannot be"
               & " written: this run leaves no trace" & ASCII.LF);
         end if;
      end if;
      Ada.Real_Time.Split (Epochs.Start, Whole, Rest);
      Put_Line
        ("E " & Image
           (Long_Long_Integer (Whole) * 1_000_000_000
            + Long_Long_Integer (Epochs.To_Nanoseconds (Rest))));
      if C_Get_Scheduler (0) /= Fifo_Policy then
         Write_All
           (Stream,
            "warning: real-time priorities are not available: run as root"
            & " or grant CAP_SYS_NICE; response times are then not bounded"
            & ASCII.LF);
      end if;
   end Start;

   --------------------
   -- Stop_Requested --
   --------------------

   function Stop_Requested return Boolean
   is (Stop_Flag or else Failures.Stop_Needed);

   ---------------
   -- Put_Model --
   ---------------

   procedure Put_Model (Digest : String) is
   begin
      Put_Line ("M " & Digest);
   end Put_Model;

   ---------------
   -- Put_Trace --
   ---------------

   procedure Put_Trace (Item : Traces.Trace_Record) is
   begin
      Put_Line
        ("T " & Image (Long_Long_Integer (Item.At_Time))
         & ' ' & Capitalized (Item.Kind'Image)
         & ' ' & Image (Long_Long_Integer (Item.Element))
         & ' ' & Image (Long_Long_Integer (Item.Value)));
   end Put_Trace;

   -------------------
   -- Put_Processor --
   -------------------

   procedure Put_Processor
     (Id             : Element_Id;
      Releases       : Event_Count;
      Misses         : Event_Count;
      Worst_Response : Nanoseconds) is
   begin
      Put_Line
        ("P " & Image (Long_Long_Integer (Id))
         & ' ' & Image (Long_Long_Integer (Releases))
         & ' ' & Image (Long_Long_Integer (Misses))
         & ' ' & Image (Long_Long_Integer (Worst_Response)));
   end Put_Processor;

   ------------------
   -- Put_Activity --
   ------------------

   procedure Put_Activity (Id : Element_Id; Worst_Execution : Nanoseconds) is
   begin
      Put_Line
        ("A " & Image (Long_Long_Integer (Id))
         & ' ' & Image (Long_Long_Integer (Worst_Execution)));
   end Put_Activity;

   ---------------------
   -- Put_Fault_Count --
   ---------------------

   procedure Put_Fault_Count (Kind : Health.Fault_Kind; Count : Event_Count)
   is
   begin
      Put_Line
        ("H " & Capitalized (Kind'Image)
         & ' ' & Image (Long_Long_Integer (Count)));
   end Put_Fault_Count;

   --------------
   -- Put_Lost --
   --------------

   procedure Put_Lost (What : String; Count : Event_Count) is
   begin
      Put_Line ("L " & What & ' ' & Image (Long_Long_Integer (Count)));
   end Put_Lost;

   ----------------------
   -- Put_Host_Latency --
   ----------------------

   procedure Put_Host_Latency (Longest : Nanoseconds) is
   begin
      Put_Line ("W " & Image (Long_Long_Integer (Longest)));
   end Put_Host_Latency;

   -------------
   -- Put_Now --
   -------------

   procedure Put_Now is
      Now : Nanoseconds;
   begin
      Epochs.Since_Start (Now);
      Put_Line ("N " & Image (Long_Long_Integer (Now)));
   end Put_Now;

   ---------------
   -- Put_Feeds --
   ---------------

   procedure Put_Feeds (Count : Event_Count) is
   begin
      Put_Line ("F " & Image (Long_Long_Integer (Count)));
   end Put_Feeds;

   ------------
   -- Finish --
   ------------

   procedure Finish (Success : Boolean) is
      Failed  : constant Boolean := Failures.Stop_Needed;
      Ignored : C_Int;
   begin
      Put_Line ("END");
      Flush;
      --  What the user's own bodies printed goes out as well.
      Ignored := C_Flush (System.Null_Address);
      Failures.Put_Reasons;
      C_Exit (if Success and then not Failed then 0 else 1);
   end Finish;

end Ravenchart.Hosts;
