--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Frames in the format of a CTU CAN FD core, converted both ways and from any
--  words; and the meaning of the words of its registers.

with Facts;
with Interfaces;
with Ravenchart.Can;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Arbitration;
with Ravenchart.Can.Ctu_Buffers;
with Ravenchart.Can.Ctu_Frames;
with Ravenchart.Can.Ctu_Registers;
with Ravenchart.Can.Fd_Frames;

procedure Test_Ctu_Frames is
   use Ravenchart.Can;
   use Ravenchart.Can.Ctu_Frames;
   use Ravenchart.Can.Fd_Frames;
   use type Interfaces.Unsigned_32;
   use type Interfaces.Unsigned_64;
   use type Arbitration.Rank;
   use type Ctu_Registers.Bit_Timing;
   use type Ctu_Registers.Buffer;
   use type Ctu_Registers.Hertz;

   package Registers renames Ctu_Registers;

   Base : constant Frame_Format := Ravenchart.Can.Standard;
   --  The literal alone would be hidden by package Standard.

   Bits : constant Interfaces.Unsigned_64 := 16#8877_6655_4433_2211#;

   type Frame_List is array (Positive range <>) of Frame;

   type Word_List is array (Positive range <>) of Interfaces.Unsigned_32;

   type Rate_List is array (Positive range <>) of Registers.Hertz;

   procedure Check_Lengths;

   procedure Check_Words;

   procedure Check_Any_Words;

   procedure Check_Registers;

   procedure Check_Order;

   procedure Check_Timing;

   -------------------
   -- Check_Lengths --
   -------------------

   procedure Check_Lengths is
      Bytes : Fd_Bytes;
      Good  : Boolean := True;
      Fd    : Fd_Frame;
   begin
      for Length in Data_Length loop
         for F of Frame_List'
           (Data_Frame (16#7FF#, Base, Length, Bits),
            Data_Frame (2**29 - 1, Extended, Length, Bits),
            Remote_Frame (16#123#, Base, Length),
            Remote_Frame (0, Extended, Length))
         loop
            Good := Good and then Frame_Of (Image_Of (F)) = F;
         end loop;
      end loop;
      Facts.Check ("classic frames of every length come back", Good);
      for B in Fd_Index loop
         Bytes (B) := Interfaces.Unsigned_8 (B + 100);
      end loop;
      Good := True;
      for Code in Length_Code loop
         for Format in Frame_Format loop
            for Rate in Bit_Rate_Use loop
               for Sender in Sender_State loop
                  Fd := Fd_Data_Frame
                    (16#555#, Format, Length_Of (Code), Bytes, Rate,
                     Sender);
                  Good := Good
                    and then Is_Fd (Image_Of (Fd))
                    and then Fd_Frame_Of (Image_Of (Fd)) = Fd;
               end loop;
            end loop;
         end loop;
      end loop;
      Facts.Check ("FD frames of every length come back", Good);
   end Check_Lengths;

   -----------------
   -- Check_Words --
   -----------------

   procedure Check_Words is
      Classic : constant Image :=
        Image_Of (Data_Frame (16#18FF_00AA#, Extended, 5, Bits));
      Fd      : constant Image :=
        Image_Of
          (Fd_Data_Frame
             (16#123#, Base, 12, (0 => 16#AB#, 11 => 16#CD#, others => 0)));
      Long    : Image := Classic;
      Asked   : Image := Image_Of (Remote_Frame (1, Base, 8));
   begin
      Facts.Check
        ("a classic frame has the words of the datasheet",
         Classic.Layout = 16#2845#
         and then Classic.Identity = 16#18FF_00AA#
         and then Classic.Data (0) = 16#4433_2211#
         and then Classic.Data (1) = 16#55#);
      Facts.Check
        ("an FD frame has them",
         Fd.Layout = 16#3289#
         and then Fd.Identity = 16#048C_0000#
         and then Fd.Data (0) = 16#AB#
         and then Fd.Data (2) = 16#CD00_0000#);
      Long.Layout   := (Long.Layout and not 16#F#) or 13;
      Long.Data (1) := 16#8877_6655#;
      Facts.Check
        ("a code above eight stands for eight bytes",
         Frame_Of (Long).Length = 8
         and then Payload (Frame_Of (Long)) = Bits);
      Asked.Data (0) := 16#DEAD_BEEF#;
      Facts.Check
        ("a remote frame has no data, whatever was left there",
         Frame_Of (Asked) = Remote_Frame (1, Base, 8));
   end Check_Words;

   ---------------------
   -- Check_Any_Words --
   ---------------------

   procedure Check_Any_Words is
      Seed : Interfaces.Unsigned_32 := 1;
      I    : Image;
      Good : Boolean := True;

      function Next_Word return Interfaces.Unsigned_32;

      function Next_Word return Interfaces.Unsigned_32 is
      begin
         Seed := Seed xor Interfaces.Shift_Left (Seed, 13);
         Seed := Seed xor Interfaces.Shift_Right (Seed, 17);
         Seed := Seed xor Interfaces.Shift_Left (Seed, 5);
         return Seed;
      end Next_Word;

   begin
      for Nth in 1 .. 2_000 loop
         I :=
           (Layout => Next_Word, Identity => Next_Word,
            Stamp_Low => Next_Word, Stamp_High => Next_Word,
            Data => (others => Next_Word));
         if Is_Fd (I) then
            Good := Good
              and then Fd_Frame_Of (Image_Of (Fd_Frame_Of (I)))
                       = Fd_Frame_Of (I);
         else
            Good := Good
              and then Frame_Of (Image_Of (Frame_Of (I))) = Frame_Of (I);
         end if;
      end loop;
      Facts.Check ("any words are a frame, which comes back", Good);
   end Check_Any_Words;

   ---------------------
   -- Check_Registers --
   ---------------------

   procedure Check_Registers is
   begin
      Facts.Check
        ("a core is known by its name, and its absence too",
         Registers.Is_Core (16#0202_CAFD#)
         and then not Registers.Is_Core (0)
         and then not Registers.Is_Core (16#FFFF_FFFF#));
      Facts.Check
        ("the state follows the flags",
         Registers.State_Of (2**16, Stopped) = Error_Active
         and then Registers.State_Of (2**17, Error_Active) = Error_Passive
         and then Registers.State_Of (2**18, Error_Passive) = Bus_Off
         and then Registers.State_Of (2**18, Stopped) = Stopped);
      Facts.Check
        ("the error counters are seen where they are",
         Registers.Receive_Errors (16#0100_0007#) = 7
         and then Registers.Transmit_Errors (16#0100_0007#) = 256
         and then Registers.Transmit_Errors (16#FFFF_FFFF#) = 256);
      Facts.Check
        ("each buffer has a priority of its own",
         Registers.Priorities (4, 3, 2, 1) = 16#1234#
         and then Registers.Priority_Of (16#4123#, 1) = 3
         and then Registers.Priority_Of (16#4123#, 4) = 4);
   end Check_Registers;

   -----------------
   -- Check_Order --
   -----------------

   procedure Check_Order is
      Line : Ctu_Buffers.Line;
      Slot : Registers.Buffer;
      Good : Boolean := True;

      procedure Put (Rank : Arbitration.Rank; Wanted : Interfaces.Unsigned_32);
      --  Put a frame of this rank, after which TX_PRIORITY is Wanted.

      procedure Put (Rank : Arbitration.Rank; Wanted : Interfaces.Unsigned_32)
      is
      begin
         Ctu_Buffers.Put (Line, Rank, Slot);
         Good := Good and then Ctu_Buffers.Priorities (Line) = Wanted;
      end Put;

      function Urgency
        (Id     : Identifier;
         Format : Frame_Format;
         Kind   : Frame_Kind := Data) return Arbitration.Rank
      is (Ctu_Buffers.Urgency
            (Any_Frames.To_Any
               (Frame'(Id => Id, Format => Format, Kind => Kind,
                       others => <>))));
   begin
      for Nth in 1 .. 4 loop
         Put (0, 16#1234#);
      end loop;
      for Wanted of Word_List'(16#2341#, 16#3412#, 16#4123#, 16#1234#) loop
         Ctu_Buffers.Remove (Line, 1);
         Put (0, Wanted);
      end loop;
      Facts.Check ("frames of one rank go along the ring of buffers", Good);

      Good := True;
      Line := (others => <>);
      Put (70, 16#1234#);
      Put (50, 16#1243#);
      Put (50, 16#1342#);
      Put (10, 16#4231#);
      Facts.Check ("the lower rank has the higher priority", Good);

      Ctu_Buffers.Remove (Line, 4);
      Put (20, 16#4123#);
      Facts.Check
        ("the buffer of a frame that has gone takes one between others",
         Good and then Slot = 1);
      Facts.Check
        ("a standard frame is more urgent than an extended one with its base",
         Urgency (5, Base, Data) < Urgency (5, Base, Remote)
         and then Urgency (5, Base, Remote) < Urgency (5 * 2**18, Extended)
         and then Urgency (5 * 2**18, Extended) < Urgency (6, Base));
   end Check_Order;

   ------------------
   -- Check_Timing --
   ------------------

   procedure Check_Timing is
      T     : Registers.Bit_Timing;
      Found : Boolean;
      Good  : Boolean := True;

      procedure Choose_Nominal
        (Rate  : Registers.Hertz;
         T     : out Registers.Bit_Timing;
         Found : out Boolean);
      --  Choose a timing with the clock of the PCI card.

      procedure Choose_Nominal
        (Rate  : Registers.Hertz;
         T     : out Registers.Bit_Timing;
         Found : out Boolean) is
      begin
         Registers.Choose_Timing
           (100_000_000, Rate, Registers.Quanta_Count'Last, T, Found);
      end Choose_Nominal;
   begin
      for Rate of Rate_List'
        (10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000,
         800_000, 1_000_000, 2_000_000, 5_000_000)
      loop
         Choose_Nominal (Rate, T, Found);
         Good := Good
           and then Found
           and then T.Prescaler * Registers.Quanta (T) * Rate
                    = 100_000_000;
      end loop;
      Facts.Check ("the usual bit rates are had exactly", Good);
      Choose_Nominal (500_000, T, Found);
      Facts.Check
        ("500 kbit/s has 100 quanta, sampled at 80 %",
         Found
         and then T = (Prescaler => 2, Propagation => 59,
                       Phase_1 => 20, Phase_2 => 20)
         and then Registers.Btr_Of (T) = 16#A012_8A3B#);
      Choose_Nominal (300_000, T, Found);
      Facts.Check ("what no prescaler gives is not found", not Found);
      Good := True;
      for Rate of Rate_List'
        (500_000, 1_000_000, 2_000_000, 4_000_000, 5_000_000, 10_000_000)
      loop
         Registers.Choose_Timing
           (100_000_000, Rate, Registers.Data_Quanta, T, Found);
         Good := Good
           and then Found
           and then T.Propagation < 64
           and then T.Phase_1 < 32;
      end loop;
      Facts.Check ("the data phase has room in its register", Good);
      Registers.Choose_Timing
        (100_000_000, 2_000_000, Registers.Data_Quanta, T, Found);
      Facts.Check
        ("above 1 Mbit/s a sender samples behind the delay that it measures",
         Registers.Ssp_Of (T, 2_000_000) = 40 * 2**16
         and then Registers.Ssp_Of (T, 1_000_000) = 2**24);
   end Check_Timing;

begin
   Check_Lengths;
   Check_Words;
   Check_Any_Words;
   Check_Registers;
   Check_Order;
   Check_Timing;
   Facts.Finish;
end Test_Ctu_Frames;
