--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The source of interrupts that release a processor: a task above all others
--  takes them from the unit of the target, Ravenchart.Interrupt_Lines.
--
--  Guarantees   Arrive is called once for each interrupt that is taken; those
--               that come while one is taken are one
--  Tasking      one task
--  Timing       that of Arrive
--  Analysis     one task: P above all others, C = the WCET of the interrupt
--  Assumptions  ASM-024, the line reports each interrupt

generic
   Signal : Natural;
   --  Its signal, where the program runs under Linux; 0: none.
   Number : Natural;
   --  Its number at the interrupt controller of a board.
   with procedure Arrive;
   --  Always returns, never suspends.
package Ravenchart.Interrupt_Sources
  with SPARK_Mode, Elaborate_Body
is
   procedure Take
   with Global => null;
   --  Suspend until an interrupt comes, and call Arrive. Called by the task
   --  alone, which is in the body.
end Ravenchart.Interrupt_Sources;
