--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A run-time library of nothing: types that the language asks for, on AArch64
--  without an operating system.

pragma Restrictions (No_Exception_Propagation);
pragma Restrictions (No_Finalization);
pragma Restrictions (No_Tasking);
pragma Restrictions (No_Allocators);
pragma Restrictions (No_Secondary_Stack);
pragma Restrictions (No_Implicit_Dynamic_Code);
pragma Restrictions (No_Implicit_Heap_Allocations);

package System is
   pragma Pure;
   pragma No_Elaboration_Code_All;

   type Name is (Bare_Board);
   System_Name : constant Name := Bare_Board;

   Min_Int               : constant := -2 ** (Standard'Max_Integer_Size - 1);
   Max_Int               : constant :=
     2 ** (Standard'Max_Integer_Size - 1) - 1;
   Max_Binary_Modulus    : constant := 2 ** Standard'Max_Integer_Size;
   Max_Nonbinary_Modulus : constant := 2 ** Integer'Size - 1;
   Max_Base_Digits       : constant := Long_Long_Float'Digits;
   Max_Digits            : constant := Long_Long_Float'Digits;
   Max_Mantissa          : constant := Standard'Max_Integer_Size - 1;
   Fine_Delta            : constant := 2.0 ** (-Max_Mantissa);
   Tick                  : constant := 0.0;

   type Address is private;
   pragma Preelaborable_Initialization (Address);
   Null_Address : constant Address;

   Storage_Unit : constant := 8;
   Word_Size    : constant := 64;
   Memory_Size  : constant := 2 ** 64;

   function "<"  (Left, Right : Address) return Boolean;
   function "<=" (Left, Right : Address) return Boolean;
   function ">"  (Left, Right : Address) return Boolean;
   function ">=" (Left, Right : Address) return Boolean;
   function "="  (Left, Right : Address) return Boolean;
   pragma Import (Intrinsic, "<");
   pragma Import (Intrinsic, "<=");
   pragma Import (Intrinsic, ">");
   pragma Import (Intrinsic, ">=");
   pragma Import (Intrinsic, "=");

   type Bit_Order is (High_Order_First, Low_Order_First);
   Default_Bit_Order : constant Bit_Order := Low_Order_First;
   pragma Warnings (Off, Default_Bit_Order);

   Max_Priority           : constant Positive := 30;
   Max_Interrupt_Priority : constant Positive := 31;
   subtype Any_Priority is Integer range 0 .. Max_Interrupt_Priority;
   subtype Priority is Any_Priority range 0 .. Max_Priority;
   subtype Interrupt_Priority is
     Any_Priority range Max_Priority + 1 .. Max_Interrupt_Priority;
   Default_Priority : constant Priority := 15;

private

   type Address is mod Memory_Size;
   Null_Address : constant Address := 0;

   --  What the compiler reads here of a run-time library

   Atomic_Sync_Default      : constant Boolean := False;
   Backend_Divide_Checks    : constant Boolean := False;
   Backend_Overflow_Checks  : constant Boolean := True;
   Command_Line_Args        : constant Boolean := False;
   Configurable_Run_Time    : constant Boolean := True;
   Denorm                   : constant Boolean := True;
   Duration_32_Bits         : constant Boolean := False;
   Exit_Status_Supported    : constant Boolean := False;
   Frontend_Exceptions      : constant Boolean := False;
   Machine_Overflows        : constant Boolean := False;
   Machine_Rounds           : constant Boolean := True;
   Preallocated_Stacks      : constant Boolean := True;
   Signed_Zeros             : constant Boolean := True;
   Stack_Check_Default      : constant Boolean := False;
   Stack_Check_Limits       : constant Boolean := False;
   Stack_Check_Probes       : constant Boolean := False;
   Support_Aggregates       : constant Boolean := True;
   Support_Atomic_Primitives : constant Boolean := True;
   Support_Composite_Assign : constant Boolean := True;
   Support_Composite_Compare : constant Boolean := True;
   Support_Long_Shifts      : constant Boolean := True;
   Suppress_Standard_Library : constant Boolean := True;
   Use_Ada_Main_Program_Name : constant Boolean := False;
   ZCX_By_Default           : constant Boolean := True;

end System;
