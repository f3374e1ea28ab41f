--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One CTU CAN FD core: its registers, as volatile words of memory.
--
--  Guarantees   each access reads or writes one whole word, once
--  Tasking      one task
--  Timing       that of the bus the core is on; Read_Frame at most 32
--               accesses, Write_Frame at most 20
--  Assumptions  ASM-013, the location of the words; the machine has their byte
--               order, which on PCI is little-endian

with Ravenchart.Can.Ctu_Frames;
with Ravenchart.Can.Ctu_Registers;

generic
   Behind : Natural;
   --  The core of the card: so many behind the one that the environment names.
package Ravenchart.Can.Ctu_Cores
  with
    SPARK_Mode,
    Elaborate_Body,
    Abstract_State =>
      (Registers with External => (Async_Readers, Async_Writers,
                                   Effective_Reads, Effective_Writes)),
    Initializes    => Registers
is
   procedure Open (Opened : out Boolean)
   with Global => (In_Out => Registers);
   --  Map the registers to those of the core. Before that, and where it fails,
   --  they are memory.

   procedure Read
     (From : Ctu_Registers.Register; Value : out Ctu_Registers.Word)
   with Global => (In_Out => Registers);
   --  Read one word.

   procedure Write
     (To : Ctu_Registers.Register; Value : Ctu_Registers.Word)
   with Global => (In_Out => Registers);
   --  Write one word.

   procedure Read_Frame (I : out Ctu_Frames.Image)
   with Global => (In_Out => Registers);
   --  Take the oldest frame out of the receive buffer, which must hold one.

   procedure Write_Frame
     (Into : Ctu_Registers.Buffer; I : Ctu_Frames.Image)
   with Global => (In_Out => Registers);
   --  Put a frame in a transmit buffer; it is not yet ready to be sent.

end Ravenchart.Can.Ctu_Cores;
