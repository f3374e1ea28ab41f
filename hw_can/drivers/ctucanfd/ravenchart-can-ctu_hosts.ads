--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What the CTU CAN FD driver needs of Linux: where the core is, its words in
--  the memory of this process, and a few lines said.
--
--  Guarantees   a core that is gone shows as words that are 0 or all ones,
--               never as a signal or an exception
--  Tasking      the task of the driver
--  Timing       that of Linux
--  Assumptions  ASM-013, it does so

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
   --  The file is not there or cannot be mapped; what is there is no CTU
   --  CAN FD; the bit rates cannot be had from the clock.

   function Clock return Ctu_Registers.Hertz
   with Global => null;
   --  What RAVENCHART_CTUCANFD_CLOCK says, in hertz; 100_000_000 where it is
   --  not set, which is that of the PCI card, and 0 where it is no number.

   procedure Announce
   with Global => (In_Out => Console);
   --  Say on standard output that the driver has its core.

   procedure Complain (Reason : Obstacle)
   with Global => (In_Out => Console);
   --  Say on standard error why it has none; the first time only.

   procedure Map
     (Window : System.Address; Behind : Natural; Mapped : out Boolean)
   with SPARK_Mode => Off;
   --  Put the words of a core in place of Window_Bytes of memory at Window:
   --  of the core that RAVENCHART_CTUCANFD names as FILE or FILE:N, N the
   --  digit of a core of the card (0 where there is none), or of one so
   --  many Behind it. When the core goes, zeros come in its place.

end Ravenchart.Can.Ctu_Hosts;
