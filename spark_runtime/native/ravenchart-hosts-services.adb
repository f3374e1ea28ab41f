--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces.C.Strings;
with System;
with Ravenchart.Hosts.Snapshots;

package body Ravenchart.Hosts.Services
  with SPARK_Mode => Off
--  ASM-002. Signals, files and the scheduling policy are reached through the C
--  library, by address; SPARK cannot describe a handler that the kernel calls.
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

   function C_Lock_Memory (Pages : C_Int) return C_Int
   with Import, Convention => C, External_Name => "mlockall";

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
   Present_Pages        : constant C_Int := 1;
   Future_Pages         : constant C_Int := 2;
   No_File              : constant C_Int := -1;

   --  State

   Stop_Flag : Boolean := False
   with Atomic;
   --  Set by the handler, on the thread that the kernel chooses.

   Report_File : C_Int := No_File;
   --  No_File also after a failed write: the report then ends there.

   subtype Buffer_Length is Natural range 0 .. 16_384;

   Buffer : String (1 .. Buffer_Length'Last);
   Filled : Buffer_Length := 0;

   procedure Request_Stop (Signal : C_Int)
   with Convention => C;
   --  The handler of both signals.

   procedure Write_All (File : in out C_Int; Text : String);
   --  Write Text; File becomes No_File when it cannot be written.

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

   ---------
   -- Put --
   ---------

   procedure Put (Text : String) is
   begin
      Snapshots.Note (Text);
      if Report_File /= No_File then
         if Text'Length > Buffer'Last - Filled then
            Flush;
         end if;
         Buffer (Filled + 1 .. Filled + Text'Length) := Text;
         Filled := Filled + Text'Length;
      end if;
   end Put;

   -----------
   -- Start --
   -----------

   procedure Start is
      Ignored : System.Address;
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
      if C_Get_Scheduler (0) /= Fifo_Policy then
         Write_All
           (Stream,
            "warning: real-time priorities are not available: run as root"
            & " or grant CAP_SYS_NICE; response times are then not bounded"
            & ASCII.LF);
      elsif C_Lock_Memory (Present_Pages + Future_Pages) /= 0 then
         Write_All
           (Stream,
            "warning: the memory cannot be locked: run as root or grant"
            & " CAP_IPC_LOCK; until then a task may have to wait for a page"
            & ASCII.LF);
      end if;
      Snapshots.Open;
   end Start;

   --------------------
   -- Stop_Requested --
   --------------------

   function Stop_Requested return Boolean is
   begin
      Snapshots.Refresh;
      return Stop_Flag;
   end Stop_Requested;

   ------------
   -- Finish --
   ------------

   procedure Finish (Success : Boolean) is
      --  Flush the output of the user's own bodies as well.
      Ignored : constant C_Int := C_Flush (System.Null_Address);
   begin
      Snapshots.Close;
      C_Exit (if Success then 0 else 1);
   end Finish;

end Ravenchart.Hosts.Services;
