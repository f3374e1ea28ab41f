--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The end of a frame (ISO 11898-1 (2015), end of frame, overload frame and
--  intermission). The bit at which it is valid for a receiver and for its
--  transmitter, the effect of a disturbance there, and the switch of the bit
--  rate.

with Facts;
with Ravenchart.Can;
with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Buses;
with Ravenchart.Can.Fault_Confinement;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Networks;
with Ravenchart.Can.Wire;
with Simulated;

procedure Test_Frame_Ends is
   use Ravenchart;
   use Ravenchart.Can;
   use Ravenchart.Can.Bus_Nodes;
   use Simulated;
   use type Buses.Ending;
   use type Bus_Frames.Bus_Frame;

   function Bits_Of (Frame : Bus_Frames.Bus_Frame) return Nanoseconds
   is (Nanoseconds (Wire.Length (Bus_Frames.Image_Of (Frame))) - 3);
   --  The duration up to the last bit of the end of frame.

   function Listeners return Natural;
   --  The number of nodes that have received the last frame.

   procedure Make_Passive (I : Node_Index);
   --  Make node I error-passive: it counts 128 receive errors.

   procedure Disturb
     (Bit  : Positive;
      Node : Natural := Bus_Faults.Everyone;
      Kind : Bus_Faults.Fault_Kind := Bus_Faults.Disturbed_End);
   --  Node 1 of four sends a frame with this fault.

   function Pause return Nanoseconds
   is (Net.Bus.Free_At (1) / Bit - Bits_Of (Plain (5)));
   --  Bits from the last one of the end of frame until the bus is free.

   procedure Check_Errors_Before;

   procedure Check_Last_Bit_But_One;

   procedure Check_Last_Bit;

   procedure Check_Intermission;

   procedure Check_Start_Of_Frame;

   procedure Check_Overload;

   procedure Check_Passive;

   procedure Check_Rates;

   ---------------
   -- Listeners --
   ---------------

   function Listeners return Natural is
      Count : Natural := 0;
   begin
      for Heard of Result.Heard loop
         Count := Count + (if Heard then 1 else 0);
      end loop;
      return Count;
   end Listeners;

   ------------------
   -- Make_Passive --
   ------------------

   procedure Make_Passive (I : Node_Index) is
   begin
      for Round in 1 .. 16 loop
         Count
           (Net.Bus.Nodes (I),
            Fault_Confinement.Dominant_After_Receiver_Flag);
      end loop;
   end Make_Passive;

   -------------
   -- Disturb --
   -------------

   procedure Disturb
     (Bit  : Positive;
      Node : Natural := Bus_Faults.Everyone;
      Kind : Bus_Faults.Fault_Kind := Bus_Faults.Disturbed_End) is
   begin
      Start (4);
      Send (1, Plain (5));
      Step
        ((Kind => Kind, Node => Node, Position => Bit, others => <>));
   end Disturb;

   -------------------------
   -- Check_Errors_Before --
   -------------------------

   procedure Check_Errors_Before is
      Sound : Boolean := True;
   begin
      for Node in 0 .. 4 loop
         for Place in 1 .. 5 loop
            Disturb (Place, Node);
            Sound := Sound
              and then Result.Ended = Buses.Broken
              and then Listeners = 0
              and then Transmit_Errors (1) = 8
              and then Result.Struck =
                (Bits_Of (Plain (5)) - 7 + Nanoseconds (Place)) * Bit;
            Step;
            Sound := Sound and then Result.Sent (1) and then Listeners = 3;
         end loop;
      end loop;
      Facts.Check
        ("disturbed in bits 1 to 5 of its end, nobody takes the frame",
         Sound);
      Disturb (5, Node => 3);
      Facts.Check
        ("there the flags of all but the witness begin one bit later",
         Pause = -2 + 6 + 1 + 8 + 3);
   end Check_Errors_Before;

   ----------------------------
   -- Check_Last_Bit_But_One --
   ----------------------------

   procedure Check_Last_Bit_But_One is
   begin
      Disturb (6);
      Facts.Check
        ("disturbed in the last bit but one for all, nobody takes it",
         Result.Ended = Buses.Broken and then Listeners = 0
         and then Pause = -1 + 6 + 8 + 3);
      Disturb (6, Node => 3);
      Facts.Check
        ("for one receiver, it rejects the frame and the others take it",
         Result.Ended = Buses.Broken
         and then Result.Heard (2) and then not Result.Heard (3)
         and then Result.Heard (4)
         and then Transmit_Errors (1) = 8
         and then Receive_Errors (2) = 0
         and then Receive_Errors (3) = 9
         and then Pause = -1 + 6 + 1 + 8 + 3);
      Step;
      Facts.Check
        ("and these have it twice, for the transmitter repeats it",
         Result.Sent (1) and then Listeners = 3
         and then Result.Frame = Plain (5));
      Disturb (6, Node => 1);
      Facts.Check
        ("for the transmitter, it repeats what all have taken",
         Result.Ended = Buses.Broken and then Listeners = 3
         and then Transmit_Errors (1) = 8
         and then Receive_Errors (2) = 0);
   end Check_Last_Bit_But_One;

   --------------------
   -- Check_Last_Bit --
   --------------------

   procedure Check_Last_Bit is
   begin
      Disturb (7, Node => 3);
      Facts.Check
        ("disturbed in the last bit for a receiver: an overload frame",
         Result.Ended = Buses.Whole and then Result.Sent (1)
         and then Listeners = 3
         and then Result.Overload = 1
         and then Transmit_Errors (1) = 0
         and then Receive_Errors (3) = 0
         and then Pause = 6 + 1 + 8 + 3);
      Disturb (7, Node => 1);
      Facts.Check
        ("for the transmitter: an error, and the others have it twice",
         Result.Ended = Buses.Broken and then Listeners = 3
         and then Transmit_Errors (1) = 8
         and then Receive_Errors (2) = 0
         and then Pause = 6 + 1 + 8 + 3);
      Step;
      Facts.Check
        ("the second time too", Result.Sent (1) and then Listeners = 3);
      Disturb (7);
      Facts.Check
        ("for all: an error of the transmitter, no rejection",
         Result.Ended = Buses.Broken and then Listeners = 3
         and then Transmit_Errors (1) = 8
         and then Receive_Errors (2) = 0
         and then Pause = 6 + 8 + 3);
      Disturb (700, Kind => Bus_Faults.Disturbed_Bit);
      Facts.Check
        ("a bit behind the end is the last one of the end of frame",
         Result.Ended = Buses.Broken and then Listeners = 3);
   end Check_Last_Bit;

   ------------------------
   -- Check_Intermission --
   ------------------------

   procedure Check_Intermission is
      function Whole return Boolean
      is (Result.Ended = Buses.Whole and then Result.Sent (1)
          and then Listeners = 3
          and then Result.Overload = 1
          and then Transmit_Errors (1) = 0);
      --  Have all nodes received the frame, and does an overload frame follow?
   begin
      Disturb (8);
      Facts.Check
        ("a dominant first bit of the intermission: an overload frame",
         Whole and then Pause = 1 + 6 + 8 + 3
         and then Receive_Errors (2) = 0);
      Disturb (8, Node => 3);
      Facts.Check
        ("for one node, the others follow one bit later",
         Whole and then Pause = 1 + 6 + 1 + 8 + 3
         and then Receive_Errors (2) = 0);
      Disturb (9);
      Facts.Check
        ("a dominant second bit: an overload frame",
         Whole and then Pause = 2 + 6 + 8 + 3
         and then Receive_Errors (2) = 0);
      Disturb (9, Node => 3);
      Facts.Check
        ("for one node, its flag is a start of frame for the others, and "
         & "then a stuff error",
         Whole and then Pause = 2 + 6 + 6 + 8 + 3
         and then Receive_Errors (1) = 1
         and then Receive_Errors (2) = 1
         and then Receive_Errors (3) = 0);
   end Check_Intermission;

   --------------------------
   -- Check_Start_Of_Frame --
   --------------------------

   procedure Check_Start_Of_Frame is
      Third : Nanoseconds;
   begin
      Start (4);
      Send (1, Plain (5));
      Send (2, Plain (6));
      Step
        ((Kind => Bus_Faults.Disturbed_End, Position => 10, others => <>));
      Third := Result.Finish + 2 * Bit;
      Facts.Check
        ("a dominant third bit of the intermission harms no frame",
         Result.Ended = Buses.Whole and then Result.Overload = 0);
      Step;
      Facts.Check
        ("it is the start of the next frame, one bit early",
         Result.Start = Third and then Result.Sent (2)
         and then Listeners = 3
         and then Result.Finish =
           Third + Bits_Of (Result.Frame) * Bit);

      Disturb (10);
      Third := Result.Finish + 2 * Bit;
      Step;
      Facts.Check
        ("where nobody has a frame, all see a stuff error",
         Result.Ended = Buses.Silence
         and then Receive_Errors (1) = 1
         and then Receive_Errors (4) = 1
         and then Net.Bus.Free_At (1) = Third + (7 + 6 + 8 + 3) * Bit);
      Step;
      Facts.Check
        ("once", Result.Ended = Buses.Silence
         and then Receive_Errors (1) = 1
         and then not Networks.Next (Net).Known);
   end Check_Start_Of_Frame;

   --------------------
   -- Check_Overload --
   --------------------

   procedure Check_Overload is
   begin
      for Count in 1 .. 3 loop
         Disturb (Count, Node => 3, Kind => Bus_Faults.Overload);
         Facts.Check
           ("a receiver delays the next frame by at most two overload "
            & "frames:" & Count'Image,
            Result.Ended = Buses.Whole and then Listeners = 3
            and then Result.Overload = Natural'Min (Count, 2)
            and then Pause =
              Nanoseconds (Natural'Min (Count, 2)) * (6 + 1 + 8) + 3
            and then Receive_Errors (3) = 0);
      end loop;
      Disturb (1, Node => 1, Kind => Bus_Faults.Overload);
      Facts.Check
        ("a transmitter does not", Result.Overload = 0 and then Pause = 3);
   end Check_Overload;

   -------------------
   -- Check_Passive --
   -------------------

   procedure Check_Passive is
      procedure Disturb_Passive (Place : Positive; Node : Node_Index);

      procedure Disturb_Passive (Place : Positive; Node : Node_Index) is
      begin
         Start (4);
         Make_Passive (Node);
         Send (1, Plain (5));
         Step
           ((Kind     => Bus_Faults.Disturbed_End,
             Node     => Natural (Node),
             Position => Place,
             others   => <>));
      end Disturb_Passive;
   begin
      Disturb_Passive (6, 3);
      Facts.Check
        ("an error-passive receiver rejects the frame alone",
         Result.Ended = Buses.Whole and then Listeners = 2
         and then not Result.Heard (3) and then Pause = 3);
      Disturb_Passive (7, 3);
      Facts.Check
        ("its overload flag is dominant as any other",
         Result.Ended = Buses.Whole and then Listeners = 3
         and then Pause = 6 + 1 + 8 + 3);
      Disturb_Passive (7, 1);
      Facts.Check
        ("an error-passive transmitter repeats, and disturbs nobody",
         Result.Ended = Buses.Broken and then Listeners = 3
         and then Transmit_Errors (1) = 8
         and then Receive_Errors (2) = 0
         and then Pause = 6 + 8 + 3);
      Disturb_Passive (3, 1);
      Facts.Check
        ("anywhere in its end of frame",
         Result.Ended = Buses.Broken and then Listeners = 3);
   end Check_Passive;

   -----------------
   -- Check_Rates --
   -----------------

   procedure Check_Rates is
      Fast  : constant Nanoseconds := 500;
      Frame : constant Bus_Frames.Bus_Frame :=
        (Family => Bus_Frames.Flexible,
         Fd     => Fd_Frames.Fd_Data_Frame
           (16#123#, Ravenchart.Can.Standard, 16, (others => 16#5A#)));
      Image : constant Wire.Image := Bus_Frames.Image_Of (Frame);
      Brs   : constant Positive := Image.Ends (Wire.Format_Bits);
      Crc   : constant Positive := Image.Ends (Wire.Check_Field);

      function Ends_At (Place : Positive) return Nanoseconds
      is (if Place < Brs
          then Nanoseconds (Place) * Bit
          elsif Place <= Crc
          then Nanoseconds (Brs - 1) * Bit
            + Bit * 8 / 10 + Fast * 2 / 10
            + Nanoseconds (Place - Brs) * Fast
          else Nanoseconds (Brs - 1) * Bit
            + Bit * 8 / 10 + Fast * 2 / 10
            + Nanoseconds (Crc - Brs) * Fast
            + Fast * 8 / 10 + Bit * 2 / 10
            + Nanoseconds (Place - Crc - 1) * Bit);
      --  Segment by segment: sample points at 80 % of both bits.

      Sound : Boolean := True;
   begin
      for Place in 1 .. Image.Ends (Wire.End_Of_Frame) loop
         Start (3);
         Send (1, Frame);
         Step
           ((Kind     => Bus_Faults.Disturbed_Bit,
             Position => Place,
             others   => <>));
         Sound := Sound
           and then Result.Ended = Buses.Broken
           and then Result.Struck = Ends_At (Place);
      end loop;
      Facts.Check
        ("the rate changes at the sample points of BRS and CRC delimiter",
         Sound);
      Start (3);
      Send (1, Frame);
      Step;
      Facts.Check
        ("and the frame lasts accordingly",
         Result.Finish = Ends_At (Image.Ends (Wire.End_Of_Frame))
         and then Net.Bus.Free_At (1) = Result.Finish + 3 * Bit);
   end Check_Rates;

begin
   Check_Errors_Before;
   Check_Last_Bit_But_One;
   Check_Last_Bit;
   Check_Intermission;
   Check_Start_Of_Frame;
   Check_Overload;
   Check_Passive;
   Check_Rates;
   Facts.Finish;
end Test_Frame_Ends;
