--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Zynq UltraScale+ MPSoC: an interrupt of the controller GIC-400. Its line is
--  edge-triggered: one that stays active until its device is read would
--  interrupt again at once.
--
--  Guarantees   an interrupt that comes while none is awaited waits; more of
--               them are one
--  Tasking      one caller of Wait for each line
--  Timing       Wait suspends; the handler takes constant time
--  Assumptions  ASM-024

with Ada.Interrupts;
with System;

package Ravenchart.Interrupt_Lines
  with SPARK_Mode => Off
--  ASM-024. SPARK does not follow calls by an interrupt.
is
   protected type Handler (Number : Natural)
     with Interrupt_Priority => System.Interrupt_Priority'Last
   is
      entry Wait;
   private
      procedure Handle
      with Attach_Handler => Ada.Interrupts.Interrupt_ID (Number);

      Came : Boolean := False;
   end Handler;

   type Line (Signal, Number : Natural) is limited record
      Attached : Handler (Number);
   end record;

   procedure Open (Self : Line) is null;
   --  The handler is attached when the line is elaborated.

   procedure Wait (Self : in out Line);
   --  Suspend the caller until an interrupt comes.

end Ravenchart.Interrupt_Lines;
