--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One CAN controller of Zynq-7000 or Zynq UltraScale+: its registers, as
--  volatile words at their address.
--
--  Guarantees   each access reads or writes one whole word, once
--  Tasking      one task, and the interrupt handler of the same controller
--  Timing       that of the bus the controller is on; a frame four accesses
--  Assumptions  ASM-022, the address of the words

with Interfaces;
with Ravenchart.Can.Xcan_Frames;
with Ravenchart.Can.Xcan_Registers;

generic
   Base : Interfaces.Unsigned_32;
   --  The address of the first register.
package Ravenchart.Can.Xcan_Cores
  with
    SPARK_Mode,
    Elaborate_Body,
    Abstract_State =>
      (Registers with External => (Async_Readers, Async_Writers,
                                   Effective_Reads, Effective_Writes)),
    Initializes    => Registers
is
   use type Xcan_Registers.Hertz;

   procedure Read
     (From : Xcan_Registers.Register; Value : out Xcan_Registers.Word)
   with Global => (In_Out => Registers);
   --  Read one word.

   procedure Write
     (To : Xcan_Registers.Register; Value : Xcan_Registers.Word)
   with Global => (In_Out => Registers);
   --  Write one word.

   procedure Read_Frame (I : out Xcan_Frames.Image)
   with Global => (In_Out => Registers);
   --  Take the oldest frame out of the receive FIFO, which must hold one.

   procedure Write_Frame (I : Xcan_Frames.Image)
   with Global => (In_Out => Registers);
   --  Put a frame into the transmit FIFO, which must have room: it is sent
   --  after those before it.

   procedure Configure (Clock, Rate : Xcan_Registers.Hertz; Done : out Boolean)
   with
     Global => (In_Out => Registers),
     Pre    => Rate > 0 and then Rate <= 2**30;
   --  Reset the controller, and let it join the bus with this bit rate and
   --  without filters. It stays in reset where the clock does not allow the
   --  rate.

end Ravenchart.Can.Xcan_Cores;
