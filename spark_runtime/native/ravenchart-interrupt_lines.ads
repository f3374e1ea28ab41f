--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Linux: a signal stands for an interrupt.
--
--  Guarantees   a signal that comes while none is awaited waits; more of them
--               are one
--  Tasking      one caller of Wait for each line
--  Timing       Wait suspends
--  Assumptions  ASM-024
--
--  Pragma Attach_Handler is no way here. The unit of GNAT's library behind it
--  is compiled with another partition elaboration policy, and does not bind
--  with Sequential, which proof needs.

package Ravenchart.Interrupt_Lines
  with SPARK_Mode => Off
--  ASM-024. Signals are taken through the C library, by address.
is
   type Line (Signal, Number : Natural) is limited null record;

   procedure Open (Self : Line);
   --  Keep the signal for Wait. Called once, before any task is activated: it
   --  is then blocked in each of them.

   procedure Wait (Self : in out Line);
   --  Suspend the caller until the signal comes.

end Ravenchart.Interrupt_Lines;
