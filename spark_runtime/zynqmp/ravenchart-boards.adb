--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with GNAT.IO;
with Interfaces;
with System.Machine_Code;

package body Ravenchart.Boards
--  ASM-014. Words of memory and registers are reached by address, and an
--  emulator by its semihosting call.
is
   use type Interfaces.Unsigned_64;

   --  Words that an emulator loads beside the image, for a run that ends

   Loaded : constant Interfaces.Unsigned_64 := 16#4E55_5254_5241_4843#;
   --  "CHARTRUN": the run time is set. No image reaches this address.

   Mark : Interfaces.Unsigned_64
   with
     Import,
     Volatile,
     Address => System'To_Address (16#7000_0000#);

   Length : Interfaces.Unsigned_64
   with
     Import,
     Volatile,
     Address => System'To_Address (16#7000_0008#);
   --  The run time in nanoseconds.

   --  The watchdog of the low-power domain, WDT of UG1085

   Restart : Interfaces.Unsigned_32
   with
     Import,
     Volatile_Full_Access,
     Address => System'To_Address (16#FF15_0008#);
   Restart_Key : constant Interfaces.Unsigned_32 := 16#1999#;

   --  Semihosting for AArch64

   Exit_Extended    : constant Interfaces.Unsigned_64 := 16#20#;
   Application_Exit : constant Interfaces.Unsigned_64 := 16#2_0026#;

   type Exit_Block is record
      Reason : Interfaces.Unsigned_64;
      Status : Interfaces.Unsigned_64;
   end record
   with Convention => C;

   function Emulated return Boolean
   is (Mark = Loaded);

   ---------
   -- Put --
   ---------

   procedure Put (Text : String) is
   begin
      GNAT.IO.Put (Text);
   end Put;

   --------------
   -- Run_Time --
   --------------

   function Run_Time return Nanoseconds is
      Asked : constant Interfaces.Unsigned_64 := Length;
   begin
      return
        (if Emulated and then Asked < Interfaces.Unsigned_64 (Nanoseconds'Last)
         then Nanoseconds (Asked)
         else Nanoseconds'Last);
   end Run_Time;

   -------------------
   -- Feed_Watchdog --
   -------------------

   procedure Feed_Watchdog is
   begin
      Restart := Restart_Key;
   end Feed_Watchdog;

   ------------
   -- Finish --
   ------------

   procedure Finish (Success : Boolean) is
      Block : Exit_Block :=
        (Reason => Application_Exit, Status => (if Success then 0 else 1))
      with Volatile;
   begin
      if Emulated then
         System.Machine_Code.Asm
           ("mov x0, %0" & ASCII.LF & ASCII.HT
            & "mov x1, %1" & ASCII.LF & ASCII.HT
            & "hlt #0xF000",
            Inputs   =>
              (Interfaces.Unsigned_64'Asm_Input ("r", Exit_Extended),
               System.Address'Asm_Input ("r", Block'Address)),
            Clobber  => "x0,x1,memory",
            Volatile => True);
      end if;
      loop
         null;
      end loop;
      --  The watchdog, which is no longer fed, resets the board.
   end Finish;

end Ravenchart.Boards;
