--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Synchronous_Task_Control;
with Interfaces;
with Ravenchart.Boards;
with Ravenchart.Can;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Slcan;
with Ravenchart.Can.Xcan_Cores;
with Ravenchart.Can.Xcan_Frames;
with Ravenchart.Can.Xcan_Registers;
with Ravenchart.Epochs;
with Ravenchart.Schedules;
with System.Machine_Code;
with System.Storage_Elements;

package body Ravenchart.Gateways is
   use type Interfaces.Unsigned_32;
   use type Interfaces.Unsigned_64;
   use type Interfaces.Unsigned_8;
   use type Can.Any_Frames.Frame_Family;
   use type Can.Slcan.Outcome;

   package Registers renames Can.Xcan_Registers;

   package Bus is new Can.Xcan_Cores (16#FF07_0000#);
   --  CAN1.

   Clock : constant := 100_000_000;
   Rate  : constant := 500_000;
   --  The emulator has no bit timing: any rate joins.

   Period : constant := 1_000_000;
   --  The time from one look to the next.

   Line_Feed           : constant Interfaces.Unsigned_8 := 10;
   End_Of_Transmission : constant Interfaces.Unsigned_8 := 4;

   Run_Time : Interfaces.Unsigned_64
   with
     Import,
     Volatile,
     Address => System'To_Address (16#7000_0008#);
   --  The run time that the emulator sets, see Ravenchart.Boards.

   --  Semihosting for AArch64

   type Words is array (1 .. 3) of Interfaces.Unsigned_64
   with Convention => C;

   Sys_Open  : constant Interfaces.Unsigned_64 := 16#01#;
   Sys_Write : constant Interfaces.Unsigned_64 := 16#05#;
   Sys_Read  : constant Interfaces.Unsigned_64 := 16#06#;

   To_Read  : constant := 0;
   To_Write : constant := 4;
   --  Modes of Sys_Open: "r" and "w" of fopen.

   Chunk : constant := 4_096;

   type Chunk_Bytes is array (1 .. Chunk) of Interfaces.Unsigned_8;

   function Call
     (Operation : Interfaces.Unsigned_64; Block : Words)
      return Interfaces.Unsigned_64;
   --  Ask the emulator.

   function Opened
     (Name : String; Mode : Interfaces.Unsigned_64)
      return Interfaces.Unsigned_64;
   --  The handle of a pipe; Name ends with a zero. The controller ends where
   --  there is none.

   function Number (Place : System.Address) return Interfaces.Unsigned_64
   is (Interfaces.Unsigned_64 (System.Storage_Elements.To_Integer (Place)));

   Input       : Chunk_Bytes;
   Output      : Chunk_Bytes;
   Written     : Natural range 0 .. Chunk := 0;
   From_Bench  : Interfaces.Unsigned_64 := 0;
   To_Bench    : Interfaces.Unsigned_64 := 0;
   Parser      : Can.Slcan.Parser;

   Started : Ada.Synchronous_Task_Control.Suspension_Object;

   task Gateway
   with Priority => System.Priority'First + 1, Storage_Size => 16 * 1_024;

   procedure Tell;
   --  Write the frames that have come on the bus.

   procedure Ask;
   --  Read the commands of the bench, as far as a line feed, and execute them.

   procedure Obey (Byte : Interfaces.Unsigned_8);
   --  Take one byte of the bench.

   procedure Flush;
   --  Hand over the output.

   ----------
   -- Call --
   ----------

   function Call
     (Operation : Interfaces.Unsigned_64; Block : Words)
      return Interfaces.Unsigned_64
   is
      Result : Interfaces.Unsigned_64;
   begin
      System.Machine_Code.Asm
        ("mov x0, %1" & ASCII.LF & ASCII.HT
         & "mov x1, %2" & ASCII.LF & ASCII.HT
         & "hlt #0xF000" & ASCII.LF & ASCII.HT
         & "mov %0, x0",
         Outputs  => Interfaces.Unsigned_64'Asm_Output ("=r", Result),
         Inputs   =>
           (Interfaces.Unsigned_64'Asm_Input ("r", Operation),
            System.Address'Asm_Input ("r", Block'Address)),
         Clobber  => "x0,x1,memory",
         Volatile => True);
      return Result;
   end Call;

   ------------
   -- Opened --
   ------------

   function Opened
     (Name : String; Mode : Interfaces.Unsigned_64)
      return Interfaces.Unsigned_64
   is
      Handle : constant Interfaces.Unsigned_64 :=
        Call (Sys_Open, (Number (Name'Address), Mode, Name'Length - 1));
   begin
      if Handle = Interfaces.Unsigned_64'Last then
         Boards.Put ("error: the gateway has no pipe" & ASCII.LF);
         Boards.Finish (Success => False);
      end if;
      return Handle;
   end Opened;

   -----------
   -- Flush --
   -----------

   procedure Flush is
      Left : constant Interfaces.Unsigned_64 :=
        Call
          (Sys_Write,
           (To_Bench, Number (Output'Address),
            Interfaces.Unsigned_64 (Written)));
   begin
      if Left > 0 then
         Run_Time := 0;
      end if;
      Written := 0;
   end Flush;

   ----------
   -- Tell --
   ----------

   procedure Tell is
      Causes : Registers.Word;
      Item   : Can.Xcan_Frames.Image;
      Line   : Can.Slcan.Line_Bytes;
      Last   : Can.Slcan.Line_Length;
   begin
      loop
         Bus.Write (Registers.Icr, Registers.Receive_Not_Empty);
         Bus.Read (Registers.Isr, Causes);
         exit when (Causes and Registers.Receive_Not_Empty) = 0;
         Bus.Read_Frame (Item);
         Can.Slcan.Format_Line
           (Can.Any_Frames.To_Any (Can.Xcan_Frames.Frame_Of (Item)),
            Line, Last);
         for Byte of Line (1 .. Last) loop
            Written := Written + 1;
            Output (Written) := Byte;
         end loop;
         if Written > Chunk - Can.Slcan.Line_Limit - 1 then
            Flush;
         end if;
      end loop;
      Written := Written + 1;
      Output (Written) := Line_Feed;
      Flush;
   end Tell;

   ----------
   -- Obey --
   ----------

   procedure Obey (Byte : Interfaces.Unsigned_8) is
      Result : Can.Slcan.Outcome;
      F      : Can.Any_Frames.Any_Frame;
   begin
      if Byte = End_Of_Transmission then
         Run_Time := 0;
         return;
      end if;
      Can.Slcan.Feed (Parser, Byte, Result, F);
      if Result = Can.Slcan.Frame_Line
        and then F.Family = Can.Any_Frames.Classic
      then
         Bus.Write_Frame (Can.Xcan_Frames.Image_Of (F.Plain));
      end if;
   end Obey;

   ---------
   -- Ask --
   ---------

   procedure Ask is
      Left  : Interfaces.Unsigned_64;
      Taken : Natural range 0 .. Chunk;
   begin
      loop
         Left :=
           Call (Sys_Read, (From_Bench, Number (Input'Address), Chunk));
         Taken := (if Left < Chunk then Chunk - Natural (Left) else 0);
         if Taken = 0 then
            Run_Time := 0;
            return;
         end if;
         for Byte of Input (1 .. Taken) loop
            if Byte = Line_Feed then
               return;
            end if;
            Obey (Byte);
         end loop;
      end loop;
   end Ask;

   -----------
   -- Start --
   -----------

   procedure Start is
   begin
      Ada.Synchronous_Task_Control.Set_True (Started);
   end Start;

   -------------
   -- Gateway --
   -------------

   task body Gateway is
      Release : Event_Count := 0;
      Joined  : Boolean;
   begin
      Ada.Synchronous_Task_Control.Suspend_Until_True (Started);
      Bus.Configure (Clock, Rate, Joined);
      pragma Assert (Joined);
      To_Bench   := Opened ("from_board" & ASCII.NUL, To_Write);
      From_Bench := Opened ("to_board" & ASCII.NUL, To_Read);
      loop
         delay until Epochs.Instant (Schedules.Due (0, Period, Release));
         Tell;
         Ask;
         Release := Next (Release);
      end loop;
   end Gateway;

end Ravenchart.Gateways;
