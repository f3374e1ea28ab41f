--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Frames in the format of the CAN controller of Zynq, converted both ways and
--  from any words; and the meaning of the words of its registers.

with Facts;
with Interfaces;
with Ravenchart.Can;
with Ravenchart.Can.Xcan_Frames;
with Ravenchart.Can.Xcan_Registers;

procedure Test_Xcan_Frames is
   use Ravenchart.Can;
   use Ravenchart.Can.Xcan_Frames;
   use type Interfaces.Unsigned_32;
   use type Interfaces.Unsigned_64;
   use type Xcan_Registers.Hertz;

   package Registers renames Xcan_Registers;

   Base : constant Frame_Format := Ravenchart.Can.Standard;
   --  The literal alone would be hidden by package Standard.

   Bits : constant Interfaces.Unsigned_64 := 16#8877_6655_4433_2211#;

   type Frame_List is array (Positive range <>) of Frame;

   procedure Check_Frames;

   procedure Check_Words;

   procedure Check_Registers;

   procedure Check_Timing;

   ------------------
   -- Check_Frames --
   ------------------

   procedure Check_Frames is
      Good : Boolean := True;
   begin
      for Length in Data_Length loop
         for F of Frame_List'
           (Data_Frame (16#7FF#, Base, Length, Bits),
            Data_Frame (2**29 - 1, Extended, Length, Bits),
            Data_Frame (16#1555_5555#, Extended, Length, Bits),
            Remote_Frame (16#123#, Base, Length),
            Remote_Frame (0, Extended, Length))
         loop
            Good := Good and then Frame_Of (Image_Of (F)) = F;
         end loop;
      end loop;
      Facts.Check ("frames of every kind and length come back", Good);
   end Check_Frames;

   -----------------
   -- Check_Words --
   -----------------

   procedure Check_Words is
      Plain : constant Image := Image_Of (Data_Frame (16#123#, Base, 8, Bits));
      Long  : constant Image :=
        Image_Of (Remote_Frame (16#1234_5678#, Extended, 5));
   begin
      Facts.Check
        ("a standard frame has the words of UG585",
         Plain.Identity = 16#2460_0000#
         and then Plain.Layout = 16#8000_0000#
         and then Plain.Data_Low = 16#1122_3344#
         and then Plain.Data_High = 16#5566_7788#);
      Facts.Check
        ("an extended remote frame has the words of UG585",
         Long.Identity = 16#91B8_ACF1#
         and then Long.Layout = 16#5000_0000#
         and then Long.Data_Low = 0
         and then Long.Data_High = 0);
      Facts.Check
        ("a length code above 8 stands for 8 bytes",
         Frame_Of ((Layout => 16#F000_1234#, others => 0)).Length = 8);
   end Check_Words;

   ---------------------
   -- Check_Registers --
   ---------------------

   procedure Check_Registers is
   begin
      Facts.Check
        ("the states of a controller",
         Registers.State_Of (2#0_0000_0001#) = Stopped
         and then Registers.State_Of (2#0_1000_1000#) = Error_Active
         and then Registers.State_Of (2#1_0000_1000#) = Bus_Off
         and then Registers.State_Of (2#1_1000_1000#) = Error_Passive);
      Facts.Check
        ("the error counters",
         Registers.Receive_Errors (16#FE7F#) = 16#FE#
         and then Registers.Transmit_Errors (16#FE7F#) = 16#7F#);
   end Check_Registers;

   ------------------
   -- Check_Timing --
   ------------------

   procedure Check_Timing is
      T     : Registers.Bit_Timing;
      Found : Boolean;
      Right : Boolean := True;
   begin
      for Rate in Registers.Hertz range 1 .. 8 loop
         Registers.Choose_Timing (100_000_000, Rate * 125_000, T, Found);
         Right := Right
           and then Found = (Rate in 1 | 2 | 4 | 5 | 8)
           and then
             (if Found
              then T.Prescaler * Registers.Quanta (T) * Rate * 125_000
                   = 100_000_000);
      end loop;
      Facts.Check ("the usual bit rates of a clock of 100 MHz", Right);
      Registers.Choose_Timing (100_000_000, 500_000, T, Found);
      Facts.Check
        ("the words of 500 kbit/s",
         Found
         and then Registers.Brpr_Of (T) = 9
         and then Registers.Btr_Of (T) = 16#3E#);
      Registers.Choose_Timing (100_000_000, 333, T, Found);
      Facts.Check ("a rate that cannot be had is not found", not Found);
   end Check_Timing;

begin
   Check_Frames;
   Check_Words;
   Check_Registers;
   Check_Timing;
   Facts.Finish;
end Test_Xcan_Frames;
