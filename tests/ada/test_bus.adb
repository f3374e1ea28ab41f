--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The bus in virtual time: order, lengths, acknowledgement, errors, and
--  recovery from bus-off.

with Facts;
with Interfaces;
with Ravenchart.Can;
with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Buses;
with Ravenchart.Can.Fault_Confinement;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Line_Events;
with Ravenchart.Can.Networks;
with Ravenchart.Can.Transmit_Buffers;
with Ravenchart.Can.Wire;
with Simulated;

procedure Test_Bus is
   use Ravenchart;
   use Ravenchart.Can;
   use Ravenchart.Can.Bus_Nodes;
   use Ravenchart.Can.Line_Events;
   use Simulated;
   use type Bus_Faults.Fault_Kind;
   use type Bus_Frames.Bus_Frame;
   use type Buses.Ending;
   use type Interfaces.Unsigned_32;
   use type Interfaces.Unsigned_64;

   procedure Check_Order;

   procedure Check_Lengths;

   procedure Check_Acknowledgement;

   procedure Check_Errors;

   procedure Check_Conflict;

   procedure Check_Recovery;

   -----------------
   -- Check_Order --
   -----------------

   procedure Check_Order is
      Sound : Boolean := True;
      Ids   : constant array (Node_Index range 1 .. 3) of Identifier :=
        (3, 1, 2);
   begin
      Start (4);
      for I in Ids'Range loop
         Send (I, Plain (Ids (I)));
      end loop;
      for Id in Identifier range 1 .. 3 loop
         Step;
         Sound := Sound
           and then Result.Ended = Buses.Whole
           and then Result.Frame = Plain (Id)
           and then Result.Heard (4)
           and then not Result.Heard (Result.Winner);
         for I in Ids'Range loop
            Sound := Sound
              and then
                Networks.Waiting (Net, I) = (if Ids (I) <= Id then 0 else 1);
         end loop;
      end loop;
      Step;
      Facts.Check
        ("the lower identifier goes first, and losers keep their frame",
         Sound and then Result.Ended = Buses.Silence);

      Start (2);
      for Id in reverse Identifier range 1 .. 5 loop
         Send (1, Plain (Id), Interfaces.Unsigned_32 (Id));
      end loop;
      Sound := True;
      for Id in reverse Identifier range 1 .. 5 loop
         Step;
         Sound := Sound
           and then Receipts (1).Tag = Interfaces.Unsigned_32 (Id);
      end loop;
      Facts.Check ("a FIFO buffer keeps the order", Sound);

      Start (2);
      Transmit_Buffers.Reset (Net.Buffers (1), Transmit_Buffers.By_Priority);
      for Tag in Interfaces.Unsigned_32 range 1 .. 4 loop
         Send (1, Plain (Identifier (4 - Tag / 2)), Tag);
      end loop;
      Sound := True;
      for Tag of Networks.Receipt_List'
        ((1 => (4, 0), 2 => (2, 0), 3 => (3, 0), 4 => (1, 0),
          others => <>)) (1 .. 4)
      loop
         Step;
         Sound := Sound and then Receipts (1).Tag = Tag.Tag;
      end loop;
      Facts.Check
        ("a buffer by priority offers the most urgent, the elder first",
         Sound);
   end Check_Order;

   -------------------
   -- Check_Lengths --
   -------------------

   procedure Check_Lengths is
      Long  : constant Bus_Frames.Bus_Frame :=
        (Family => Bus_Frames.Flexible,
         Fd     => Fd_Frames.Fd_Data_Frame
           (16#555#, Ravenchart.Can.Standard, 64, (others => 16#55#)));
      Image : constant Wire.Image := Bus_Frames.Image_Of (Long);
      Bits  : constant Wire.Phases :=
        Wire.Phases_Of (Image, Fd_Frames.Switched_Rate);
   begin
      Start (2);
      Send (1, Plain (16#555#, 16#5555_5555_5555_5555#));
      Step;
      Facts.Check
        ("a frame of 8 bytes without stuff bits in the data lasts as long "
         & "as its image",
         Net.Bus.Free_At (1) =
           Bit * Nanoseconds
                   (Wire.Length (Bus_Frames.Image_Of (Result.Frame)))
         and then Result.Finish = Net.Bus.Free_At (1) - 3 * Bit);
      Start (2);
      Send (1, Long);
      Step;
      Facts.Check
        ("a frame that switches its rate lasts as its two phases do",
         Net.Bus.Free_At (1) =
           Bit * Nanoseconds (Bits.Nominal) + 500 * Nanoseconds (Bits.Data)
         and then Result.Frame = Long);
   end Check_Lengths;

   ---------------------------
   -- Check_Acknowledgement --
   ---------------------------

   procedure Check_Acknowledgement is
      Before : Nanoseconds;
   begin
      Start (1);
      Send (1, Plain (5));
      Step;
      Facts.Check
        ("alone, nobody acknowledges: 8 errors, and the frame stays",
         Result.Ended = Buses.Broken
         and then Transmit_Errors (1) = 8
         and then Networks.Waiting (Net, 1) = 1);
      for I in 1 .. 500 loop
         Step;
      end loop;
      Facts.Check
        ("a node that is alone becomes passive and not bus-off",
         State (1) = Error_Passive and then Transmit_Errors (1) = 128);
      Before := Net.Bus.Free_At (1);
      Step;
      Facts.Check
        ("a passive transmitter waits for eight bits more",
         Result.Start = Before + 8 * Bit);
      Join (Net, 2);
      Step;
      Facts.Check
        ("as soon as another is there, it is sent",
         Result.Sent (1)
         and then Result.Heard (2)
         and then Transmit_Errors (1) = 127
         and then State (1) = Error_Active);
      Send (1, Plain (6));
      Step ((Kind => Bus_Faults.Lost_Acknowledgement, others => <>));
      Facts.Check
        ("where the acknowledgement is lost, nobody takes the frame",
         not Result.Heard (2)
         and then Receive_Errors (2) = 1
         and then Transmit_Errors (1) = 135);
      Step ((Kind => Bus_Faults.Lost_Acknowledgement, others => <>));
      Facts.Check
        ("but they do when the transmitter is passive: it comes twice",
         Result.Heard (2) and then not Result.Sent (1));
   end Check_Acknowledgement;

   ------------------
   -- Check_Errors --
   ------------------

   procedure Check_Errors is
      Disturbed : constant Bus_Faults.Fault :=
        (Kind => Bus_Faults.Disturbed_Bit, Position => 20, others => <>);
   begin
      Start (3);
      Send (1, Plain (5, 77));
      Step (Disturbed);
      Facts.Check
        ("a disturbed bit: 20 bits, flag and delimiter, intermission",
         Result.Ended = Buses.Broken
         and then Result.Struck = 20 * Bit
         and then Net.Bus.Free_At (1) = (20 + 14 + 3) * Bit);
      Facts.Check
        ("the transmitter counts 8, the receivers 1 each",
         Transmit_Errors (1) = 8
         and then Receive_Errors (2) = 1
         and then Receive_Errors (3) = 1);
      Step;
      Facts.Check
        ("the frame is sent again, and all count down",
         Result.Heard (2) and then Result.Heard (3)
         and then Result.Frame = Plain (5, 77)
         and then Transmit_Errors (1) = 7
         and then Receive_Errors (2) = 0);
      Start (3);
      Send (1, Plain (5));
      Step
        ((Kind     => Bus_Faults.Disturbed_Bit,
          Node     => 3,
          Position => 20,
          others   => <>));
      Facts.Check
        ("who alone saw it counts 8 more, and the flags follow each other",
         Receive_Errors (3) = 9
         and then Receive_Errors (2) = 1
         and then Net.Bus.Free_At (1) = (20 + 20 + 3) * Bit);
   end Check_Errors;

   --------------------
   -- Check_Conflict --
   --------------------

   procedure Check_Conflict is
   begin
      Start (3);
      Send (1, Plain (5, 1));
      Send (2, Plain (5, 1));
      Step;
      Facts.Check
        ("two frames that are alike are one frame on the bus",
         Result.Sent (1) and then Result.Sent (2)
         and then Result.Heard (3)
         and then not Result.Heard (1));
      Send (1, Plain (5, 1));
      Send (2, Plain (5, 2));
      Step;
      Facts.Check
        ("with one identifier and other data they break each other",
         Result.Ended = Buses.Broken
         and then Transmit_Errors (1) = 8
         and then Transmit_Errors (2) = 8);
      for I in 1 .. 40 loop
         Step;
      end loop;
      Facts.Check
        ("until both are bus-off",
         State (1) = Bus_Off and then State (2) = Bus_Off);
   end Check_Conflict;

   --------------------
   -- Check_Recovery --
   --------------------

   procedure Check_Recovery is
      Asked : constant Nanoseconds := 10**9;

      procedure Fall_Off (Restart : Restart_Delay := 0);
      --  Make node 1 bus-off, with a frame to send, on a bus that is idle from
      --  then on.

      procedure Fall_Off (Restart : Restart_Delay := 0) is
      begin
         Start (3);
         Net.Bus.Nodes (1).Restart := Restart;
         Send (1, Plain (5));
         Happen (Hold_Recessive);
         while State (1) /= Bus_Off loop
            Step;
         end loop;
         Happen (Let_Go);
      end Fall_Off;

      Frame : Nanoseconds;
   begin
      Fall_Off;
      Buses.Recover (Net.Bus, 1, Asked);
      Step;
      Facts.Check
        ("recovery counts from its request, not from an idle bus before",
         Result.Start = Asked + 1408 * Bit and then Result.Sent (1));

      Fall_Off;
      Buses.Recover (Net.Bus, 1, Asked);
      Buses.Recover (Net.Bus, 1, Asked + 100 * Bit);
      Step;
      Facts.Check
        ("a second request does not begin the count anew",
         Result.Start = Asked + 1408 * Bit and then Result.Sent (1));

      Fall_Off;
      Send (2, Plain (6));
      Step;
      Frame := Result.Start;
      Buses.Recover (Net.Bus, 1, Frame + 20 * Bit);
      Facts.Check
        ("of a frame in progress, its last 11 recessive bits count",
         Fault_Confinement.Bits_To_Recovery
           (Net.Bus.Nodes (1).Confinement) = 1408 - 11);

      Fall_Off (Restart => 100_000_000);
      Frame := Net.Bus.Free_At (1);
      Step;
      Facts.Check
        ("with a restart delay, recovery is requested when it has passed",
         Result.Start = Frame + 100_000_000 + 1408 * Bit
         and then Result.Sent (1));

      Fall_Off (Restart => 100_000_000);
      Frame := Net.Bus.Free_At (1);
      Send (2, Plain (6));
      Step;
      Facts.Check
        ("before, it counts no bit",
         Result.Heard (3)
         and then Fault_Confinement.Bits_To_Recovery
           (Net.Bus.Nodes (1).Confinement) = 1408);
      Buses.Recover (Net.Bus, 1, Net.Bus.Free_At (1));
      Frame := Net.Bus.Free_At (1);
      Step;
      Facts.Check
        ("and a request by hand may come first",
         Result.Start = Frame + 1408 * Bit and then Result.Sent (1));
   end Check_Recovery;

begin
   Check_Order;
   Check_Lengths;
   Check_Acknowledgement;
   Check_Errors;
   Check_Conflict;
   Check_Recovery;
   Facts.Finish;
end Test_Bus;
