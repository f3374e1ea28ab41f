--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The registers of the CAN controller of Zynq-7000 and Zynq UltraScale+ that
--  the driver uses, by the names of UG585 and UG1085.
--
--  Guarantees   every word that a register can hold has a meaning
--  Tasking      none: values
--  Timing       constant; Choose_Timing at most 256 steps

with Interfaces;
with Ravenchart.Can.Bit_Timings;

package Ravenchart.Can.Xcan_Registers
  with SPARK_Mode, Pure
is
   use type Bit_Timings.Hertz;
   use type Interfaces.Unsigned_32;

   subtype Word is Interfaces.Unsigned_32;

   type Register is range 0 .. 31;
   --  A word of a controller, by its offset in bytes divided by four.

   Srr         : constant Register := 16#00# / 4;  --  software reset
   Msr         : constant Register := 16#04# / 4;  --  mode select
   Brpr        : constant Register := 16#08# / 4;  --  baud rate prescaler
   Btr         : constant Register := 16#0C# / 4;  --  bit timing
   Ecr         : constant Register := 16#10# / 4;  --  error counters
   Sr          : constant Register := 16#18# / 4;  --  status
   Isr         : constant Register := 16#1C# / 4;  --  interrupt status
   Ier         : constant Register := 16#20# / 4;  --  interrupt enable
   Icr         : constant Register := 16#24# / 4;  --  interrupt clear
   Tx_Fifo     : constant Register := 16#30# / 4;  --  four words
   Tx_Priority : constant Register := 16#40# / 4;  --  four words
   Rx_Fifo     : constant Register := 16#50# / 4;  --  four words
   Afr         : constant Register := 16#60# / 4;  --  acceptance filters

   Fifo_Depth : constant := 64;
   --  Frames in each FIFO.

   --  SRR and MSR

   Reset  : constant Word := 2**0;  --  SRST
   Enable : constant Word := 2**1;  --  CEN

   --  ISR, IER and ICR

   Receive_Overflow  : constant Word := 2**6;   --  RXOFLW
   Receive_Not_Empty : constant Word := 2**7;   --  RXNEMP
   Error             : constant Word := 2**8;   --  ERROR
   Went_Off          : constant Word := 2**9;   --  BSOFF
   Transmit_Empty    : constant Word := 2**14;  --  TXFEMP

   All_Causes : constant Word :=
     Receive_Overflow or Receive_Not_Empty or Error or Went_Off
     or Transmit_Empty;
   --  The interrupts that the driver enables.

   --  SR

   function Is_Configured (Status : Word) return Boolean
   is ((Status and 2**0) /= 0)
   with Global => null;
   --  CONFIG: the controller is in reset, and its timing may be written.

   function State_Of (Status : Word) return Controller_State
   is (if Is_Configured (Status) then Stopped
       else
         (case Interfaces.Shift_Right (Status, 7) and 3 is
            when 2      => Bus_Off,
            when 3      => Error_Passive,
            when others => Error_Active))
   with Global => null;
   --  ESTAT. It is 0 in reset; QEMU's model has 0 always.

   --  ECR

   function Receive_Errors (Counts : Word) return Error_Count
   is (Error_Count (Interfaces.Shift_Right (Counts, 8) and 16#FF#))
   with Global => null;
   --  REC.

   function Transmit_Errors (Counts : Word) return Error_Count
   is (Error_Count (Counts and 16#FF#))
   with Global => null;
   --  TEC.

   --  Bit timing

   subtype Hertz is Bit_Timings.Hertz;

   subtype Quanta_Count is Hertz range 8 .. 21;
   --  Time quanta of a bit: in this range no field below is too small.

   type Bit_Timing is record
      Prescaler : Hertz range 1 .. 256 := 1;
      Segment_1 : Hertz range 1 .. 16 := 1;
      Segment_2 : Hertz range 1 .. 8 := 1;
   end record;
   --  BRP in clocks; TS1 and TS2 in quanta. SJW is one quantum.

   function Quanta (T : Bit_Timing) return Hertz
   is (1 + T.Segment_1 + T.Segment_2)
   with Global => null;
   --  The time quanta of a bit; the first one is the synchronization segment.

   procedure Choose_Timing
     (Clock, Rate : Hertz; T : out Bit_Timing; Found : out Boolean)
   with
     Global => null,
     Pre    => Rate in 1 .. 2**30,
     Post   =>
       (if Found
        then T.Prescaler * Rate * Quanta (T) = Clock
          and then Quanta (T) in Quanta_Count
          and then 5 * T.Segment_2 <= Quanta (T)
          and then 5 * (T.Segment_2 + 1) > Quanta (T));
   --  The timing that gives exactly Rate, with as many quanta as possible, and
   --  the sample point at 80 % or behind it by less than a quantum. Found is
   --  False where Clock is no suitable multiple of Rate.

   function Brpr_Of (T : Bit_Timing) return Word
   is (Word (T.Prescaler - 1))
   with Global => null;

   function Btr_Of (T : Bit_Timing) return Word
   is (Word (T.Segment_1 - 1)
       or Interfaces.Shift_Left (Word (T.Segment_2 - 1), 4))
   with Global => null;

end Ravenchart.Can.Xcan_Registers;
