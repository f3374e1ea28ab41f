--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What stands for a C library where there is none: the serial line, the end of
--  a run, and the copies that the compiler asks for.

with Interfaces;
with System;

package body Lines is
   use type Interfaces.Unsigned_32;
   use type Interfaces.Unsigned_64;
   use type Interfaces.Unsigned_8;

   type Byte_Array is array (Interfaces.Unsigned_64) of Interfaces.Unsigned_8;
   --  Memory from some address on.

   procedure Last_Chance (Message : System.Address; Line : Integer)
   with
     Export,
     Convention    => C,
     External_Name => "__gnat_last_chance_handler",
     No_Return;
   --  A contract or a check has failed: end with status 1.

   procedure Copy
     (To, From : System.Address; Length : Interfaces.Unsigned_64)
   with Export, Convention => C, External_Name => "memcpy";

   procedure Fill
     (To     : System.Address;
      Value  : Interfaces.Unsigned_32;
      Length : Interfaces.Unsigned_64)
   with Export, Convention => C, External_Name => "memset";

   function Compare
     (Left, Right : System.Address; Length : Interfaces.Unsigned_64)
      return Integer
   with Export, Convention => C, External_Name => "memcmp";

   --  UART0 of the Zynq UltraScale+ (Cadence), UG1085

   Status : Interfaces.Unsigned_32
   with Import, Volatile, Address => System'To_Address (16#FF00_002C#);
   Full   : constant Interfaces.Unsigned_32 := 16#10#;
   Fifo   : Interfaces.Unsigned_32
   with Import, Volatile, Address => System'To_Address (16#FF00_0030#);
   Control : Interfaces.Unsigned_32
   with Import, Volatile, Address => System'To_Address (16#FF00_0000#);
   Enable : constant Interfaces.Unsigned_32 := 16#14#;

   procedure Board_Exit (Code : Interfaces.Unsigned_64)
   with Import, Convention => C, External_Name => "board_exit", No_Return;

   procedure Put (C : Character) is
   begin
      Control := Enable;
      while (Status and Full) /= 0 loop
         null;
      end loop;
      Fifo := Character'Pos (C);
   end Put;

   procedure Last_Chance (Message : System.Address; Line : Integer) is
      pragma Unreferenced (Message, Line);
   begin
      Board_Exit (1);
   end Last_Chance;

   procedure Copy
     (To, From : System.Address; Length : Interfaces.Unsigned_64)
   is
      Target : Byte_Array
      with Import, Address => To;
      Source : Byte_Array
      with Import, Address => From;
   begin
      for I in 1 .. Length loop
         Target (I - 1) := Source (I - 1);
      end loop;
   end Copy;

   procedure Fill
     (To     : System.Address;
      Value  : Interfaces.Unsigned_32;
      Length : Interfaces.Unsigned_64)
   is
      Target : Byte_Array
      with Import, Address => To;
   begin
      for I in 1 .. Length loop
         Target (I - 1) := Interfaces.Unsigned_8 (Value and 16#FF#);
      end loop;
   end Fill;

   function Compare
     (Left, Right : System.Address; Length : Interfaces.Unsigned_64)
      return Integer
   is
      First  : Byte_Array
      with Import, Address => Left;
      Second : Byte_Array
      with Import, Address => Right;
   begin
      for I in 1 .. Length loop
         if First (I - 1) /= Second (I - 1) then
            return (if First (I - 1) < Second (I - 1) then -1 else 1);
         end if;
      end loop;
      return 0;
   end Compare;

end Lines;
