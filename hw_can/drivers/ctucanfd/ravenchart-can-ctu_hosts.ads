--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The services of Linux for the CTU CAN FD driver: the location of the core,
--  its words in the memory of this process, and a few messages.
--
--  Guarantees   a core that has disappeared shows as words that are 0 or all
--               ones, never as a signal or an exception
--  Tasking      the task of the driver
--  Timing       that of Linux
--  Assumptions  ASM-013, Linux does what is stated here

with System;
with Ravenchart.Can.Ctu_Registers;

package Ravenchart.Can.Ctu_Hosts
  with
    SPARK_Mode,
    Elaborate_Body,
    Abstract_State =>
      (Console with External => (Async_Readers, Async_Writers))
is
   Window_Bytes : constant := 4_096;
   --  A page of memory: it holds all words of a core.

   type Obstacle is (No_Device, No_Core, No_Bit_Rate);
   --  No_Device: the file does not exist or cannot be mapped. No_Core: it is
   --  no CTU CAN FD core. No_Bit_Rate: the clock does not allow the bit rates.

   function Clock return Ctu_Registers.Hertz
   with Global => null;
   --  The value of RAVENCHART_CTUCANFD_CLOCK in hertz: 100_000_000, the clock
   --  of the PCI card, where it is not set, and 0 where it is no number.

   procedure Announce
   with Global => (In_Out => Console);
   --  Print to standard output that the driver has its core.

   procedure Complain (Reason : Obstacle)
   with Global => (In_Out => Console);
   --  Print to standard error why there is no core; the first time only.

   procedure Map
     (Window : System.Address; Behind : Natural; Mapped : out Boolean)
   with SPARK_Mode => Off;
   --  Map the words of a core over the Window_Bytes of memory at Window.
   --  RAVENCHART_CTUCANFD names the core as FILE or FILE:N; N is the digit of
   --  a core of the card, 0 by default. The mapped core is so many Behind that
   --  one. When the core disappears, zeros replace its words.

end Ravenchart.Can.Ctu_Hosts;
