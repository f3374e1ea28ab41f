--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The registers of a CTU CAN FD core that the driver uses, by the names of
--  "CTU CAN FD IP Core: Datasheet", chapter "Memory map".
--
--  Guarantees   every word that a register can hold has a meaning
--  Tasking      none: values
--  Timing       constant; Choose_Timing at most 255 steps

with Interfaces;
with Ravenchart.Can.Bit_Timings;

package Ravenchart.Can.Ctu_Registers
  with SPARK_Mode, Pure
is
   use type Bit_Timings.Hertz;
   use type Interfaces.Unsigned_32;

   subtype Word is Interfaces.Unsigned_32;

   type Register is range 0 .. 1_023;
   --  A word of a core, by its offset in bytes divided by four.

   Device_Id_Version   : constant Register := 16#000# / 4;
   Mode_Settings       : constant Register := 16#004# / 4;
   Status              : constant Register := 16#008# / 4;
   Command             : constant Register := 16#00C# / 4;
   Btr                 : constant Register := 16#024# / 4;
   Btr_Fd              : constant Register := 16#028# / 4;
   Fault_State         : constant Register := 16#02C# / 4;
   Rec_Tec             : constant Register := 16#030# / 4;
   Rx_Status_Settings  : constant Register := 16#068# / 4;
   Rx_Data             : constant Register := 16#06C# / 4;
   Tx_Status           : constant Register := 16#070# / 4;
   Tx_Command          : constant Register := 16#074# / 4;
   Tx_Priority         : constant Register := 16#078# / 4;
   Trv_Delay           : constant Register := 16#080# / 4;

   Span : constant := 16#4000#;
   --  The distance in bytes between cores, on a card with several.

   function Is_Core (Device_Id : Word) return Boolean
   is ((Device_Id and 16#FFFF#) = 16#CAFD#)
   with Global => null;
   --  Does DEVICE_ID name a CTU CAN FD core? Where no device answers, all bits
   --  are set, or none.

   --  MODE, SETTINGS and COMMAND

   Reset       : constant Word := 2**0;   --  RST
   Fd_Enabled  : constant Word := 2**4;   --  FDE
   Automatic   : constant Word := 2**9;   --  RXBAM: a read takes the word
   Enabled     : constant Word := 2**22;  --  ENA
   Fd_Tolerant : constant Word := 2**24;  --  PEX: FD frames are no errors

   Classic_Mode : constant Word := Enabled or Automatic or Fd_Tolerant;
   --  Takes part in the bus, ignores FD frames, filters nothing, repeats
   --  without limit, and keeps waiting frames while it is bus-off.

   Fd_Mode : constant Word := Enabled or Automatic or Fd_Enabled;
   --  The same with FD frames.

   Clear_Overrun : constant Word := 2**3;  --  CDO
   Recover       : constant Word := 2**4;  --  ERCRST, the way from bus-off

   function Is_Overrun (Status : Word) return Boolean
   is ((Status and 2**1) /= 0)
   with Global => null;
   --  DOR: was a frame lost for want of room?

   --  Fault confinement

   function Is_Off (Fault_State : Word) return Boolean
   is ((Fault_State and 2**18) /= 0)
   with Global => null;
   --  BOF: bus-off, or not on the bus yet.

   function State_Of
     (Fault_State : Word; Before : Controller_State) return Controller_State
   is (if Is_Off (Fault_State)
       then (if Before = Stopped then Stopped else Bus_Off)
       elsif (Fault_State and 2**17) /= 0
       then Error_Passive
       else Error_Active)
   with Global => null;
   --  The state of the core. A core that was enabled counts as bus-off until
   --  it has seen eleven recessive bits; it is Stopped here.

   function Receive_Errors (Rec_Tec : Word) return Error_Count
   is (Error_Count (Word'Min (Rec_Tec and 16#1FF#, 256)))
   with Global => null;
   --  REC_VAL.

   function Transmit_Errors (Rec_Tec : Word) return Error_Count
   is (Error_Count
         (Word'Min
            (Interfaces.Shift_Right (Rec_Tec, 16) and 16#1FF#, 256)))
   with Global => null;
   --  TEC_VAL.

   --  Receive buffer

   function Frames_Waiting (Rx_Status : Word) return Natural
   is (Natural (Interfaces.Shift_Right (Rx_Status, 4) and 16#7FF#))
   with Global => null;
   --  RXFRC: frames that were received and not read.

   --  Transmit buffers

   type Buffer is range 1 .. 4;
   --  TXT buffers that the driver uses; a core has two to eight.

   subtype Frame_Word is Register range 0 .. 19;
   --  A word of a frame, in a transmit buffer.

   function Word_Of (B : Buffer; Index : Frame_Word) return Register
   is (Register (B) * (16#100# / 4) + Index)
   with Global => null;
   --  The register of the word: TXTB1_DATA_1 is at 16#100#.

   type Buffer_State is range 0 .. 15;
   --  TXnS of TX_STATUS.

   No_Buffer   : constant Buffer_State := 0;
   Ready       : constant Buffer_State := 1;
   In_Progress : constant Buffer_State := 2;
   Ending      : constant Buffer_State := 3;  --  abort in progress
   Sent        : constant Buffer_State := 4;

   function State_Of (Tx_Status : Word; B : Buffer) return Buffer_State
   is (Buffer_State
         (Interfaces.Shift_Right (Tx_Status, 4 * (Natural (B) - 1))
          and 16#F#))
   with Global => null;

   function Has_Buffers (Tx_Status : Word) return Boolean
   is (for all B in Buffer => State_Of (Tx_Status, B) /= No_Buffer)
   with Global => null;
   --  Does the core have all buffers that the driver uses?

   function Is_Done (Tx_Status : Word; B : Buffer) return Boolean
   is (State_Of (Tx_Status, B) not in Ready | In_Progress | Ending)
   with Global => null;
   --  May B be written?

   function Set_Ready (B : Buffer) return Word
   is (2**1 or Interfaces.Shift_Left (2**8, Natural (B) - 1))
   with Global => null;
   --  TX_COMMAND: TXCR for B.

   subtype Level is Word range 1 .. 4;
   --  A priority of a buffer: of those that are ready, the core sends the one
   --  with the highest. None is 0: in QEMU's model such a buffer is never
   --  sent.

   function Priority_Of (Tx_Priority : Word; B : Buffer) return Word
   is (Interfaces.Shift_Right (Tx_Priority, 4 * (Natural (B) - 1)) and 16#F#)
   with Global => null;
   --  The priority of B: four bits for each, TXT1P lowest.

   function Priorities (Of_1, Of_2, Of_3, Of_4 : Level) return Word
   is (Of_1
       or Interfaces.Shift_Left (Of_2, 4)
       or Interfaces.Shift_Left (Of_3, 8)
       or Interfaces.Shift_Left (Of_4, 12))
   with
     Global => null,
     Post   =>
       Priority_Of (Priorities'Result, 1) = Of_1
       and then Priority_Of (Priorities'Result, 2) = Of_2
       and then Priority_Of (Priorities'Result, 3) = Of_3
       and then Priority_Of (Priorities'Result, 4) = Of_4;
   --  TX_PRIORITY with these priorities of the buffers.

   --  Bit timing

   subtype Hertz is Bit_Timings.Hertz;

   subtype Quanta_Count is Hertz range 8 .. 155;
   --  Time quanta of a bit: in this range no field below is too small.

   Data_Quanta : constant Quanta_Count := 100;
   --  Time quanta of a bit of the data phase: up to this number no field of
   --  BTR_FD is too small.

   type Bit_Timing is record
      Prescaler   : Hertz range 1 .. 255 := 1;
      Propagation : Hertz range 0 .. 127 := 0;
      Phase_1     : Hertz range 0 .. 63 := 0;
      Phase_2     : Hertz range 0 .. 31 := 0;
   end record;
   --  BRP in clocks; PROP, PH1 and PH2 in quanta. SJW is PH2.

   function Quanta (T : Bit_Timing) return Hertz
   is (1 + T.Propagation + T.Phase_1 + T.Phase_2)
   with Global => null;
   --  The time quanta of a bit; the first one is the synchronization segment.

   procedure Choose_Timing
     (Clock, Rate : Hertz;
      Most        : Quanta_Count;
      T           : out Bit_Timing;
      Found       : out Boolean)
   with
     Global => null,
     Pre    => Rate in 1 .. 2**30,
     Post   =>
       (if Found
        then T.Prescaler * Rate * Quanta (T) = Clock
          and then Quanta (T) in Quanta_Count'First .. Most
          and then 5 * T.Phase_2 <= Quanta (T)
          and then 5 * (T.Phase_2 + 1) > Quanta (T));
   --  The timing that gives exactly Rate, with as many quanta as possible up
   --  to Most, and the sample point at 80 % or behind it by less than a
   --  quantum. Found is False where Clock is no suitable multiple of Rate.

   function Btr_Of (T : Bit_Timing) return Word
   is (Word (T.Propagation)
       or Interfaces.Shift_Left (Word (T.Phase_1), 7)
       or Interfaces.Shift_Left (Word (T.Phase_2), 13)
       or Interfaces.Shift_Left (Word (T.Prescaler), 19)
       or Interfaces.Shift_Left (Word (T.Phase_2), 27))
   with Global => null;
   --  BTR; with up to Data_Quanta also BTR_FD.

   Normal_Sampling : constant Word := 2**24;  --  SSP_SRC

   function Ssp_Of (T : Bit_Timing; Rate : Hertz) return Word
   is (if Rate > 1_000_000
       then Interfaces.Shift_Left
              (Word (Hertz'Min
                       (T.Prescaler * (Quanta (T) - T.Phase_2), 127)),
               16)
       else Normal_Sampling)
   with Global => null;
   --  TRV_DELAY: the point at which a sender samples the bits of its data
   --  phase. Above 1 Mbit/s it lies two delays behind the start of the bit.
   --  The core measures the first one, the loop delay. SSP_OFFSET, in clocks,
   --  is the second one, the part of a bit before its sample point
   --  (transmitter delay compensation, ISO 11898-1).

end Ravenchart.Can.Ctu_Registers;
