--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Error counters, the states that follow from them, recovery from bus-off,
--  and the error frames that a node may send.

with Facts;
with Ravenchart.Can;
with Ravenchart.Can.Error_Frames;
with Ravenchart.Can.Fault_Confinement;
with Ravenchart.Can.Levels;

procedure Test_Fault_Confinement is
   use Ravenchart.Can;
   use Ravenchart.Can.Error_Frames;
   use Ravenchart.Can.Fault_Confinement;

   procedure Repeat
     (N : in out Node; Event : Fault_Event; Times : Positive);
   --  Count the same event again and again.

   function Listen
     (N : Node; Bus : Levels.Level; Bits : Positive) return Node;
   --  N after so many bits of one level.

   function Is_At
     (N : Node; State : Connected_State; Transmit, Receive : Error_Count)
     return Boolean
   is (Fault_Confinement.State (N) = State
       and then Transmit_Errors (N) = Transmit
       and then Receive_Errors (N) = Receive);
   --  Does N have exactly these counters and this state?

   procedure Check_Transmitter;

   procedure Check_Receiver;

   procedure Check_Recovery;

   procedure Check_Error_Frames;

   ------------
   -- Repeat --
   ------------

   procedure Repeat
     (N : in out Node; Event : Fault_Event; Times : Positive) is
   begin
      for I in 1 .. Times loop
         Count (N, Event);
      end loop;
   end Repeat;

   ------------
   -- Listen --
   ------------

   function Listen
     (N : Node; Bus : Levels.Level; Bits : Positive) return Node
   is
      Result : Node := N;
   begin
      for I in 1 .. Bits loop
         Monitor (Result, Bus);
      end loop;
      return Result;
   end Listen;

   -----------------------
   -- Check_Transmitter --
   -----------------------

   procedure Check_Transmitter is
      N : Node;
   begin
      Facts.Check
        ("a node joins error-active", Is_At (N, Error_Active, 0, 0));
      Repeat (N, Transmitter_Error, 15);
      Facts.Check
        ("15 failed transmissions leave it active",
         Is_At (N, Error_Active, 120, 0));
      Count (N, Transmitter_Error);
      Facts.Check
        ("the 16th makes it passive", Is_At (N, Error_Passive, 128, 0));
      Count (N, Transmitted);
      Facts.Check
        ("one good transmission makes it active again",
         Is_At (N, Error_Active, 127, 0));
      Repeat (N, Unanswered, 1000);
      Facts.Check
        ("nobody's answer never makes a node bus-off",
         Is_At (N, Error_Passive, 135, 0));
      Repeat (N, Stuff_Bit_Overruled, 10);
      Facts.Check
        ("a stuff bit lost in arbitration is no error",
         Is_At (N, Error_Passive, 135, 0));
      Repeat (N, Transmitter_Flag_Error, 7);
      Repeat (N, Transmitter_Held_Dominant, 8);
      Facts.Check
        ("255 is still passive", Is_At (N, Error_Passive, 255, 0));
      Count (N, Transmitter_Error);
      Facts.Check ("256 is bus-off", Is_At (N, Bus_Off, 256, 0));
   end Check_Transmitter;

   --------------------
   -- Check_Receiver --
   --------------------

   procedure Check_Receiver is
      N : Node;
   begin
      Count (N, Received);
      Repeat (N, Receiver_Error, 3);
      Repeat (N, Dominant_After_Receiver_Flag, 2);
      Count (N, Received);
      Facts.Check
        ("a receiver counts 1 for an error, 8 for one it caused alone",
         Is_At (N, Error_Active, 0, 18));
      Repeat (N, Receiver_Flag_Error, 10);
      Repeat (N, Receiver_Held_Dominant, 100);
      Facts.Check
        ("a receiver becomes passive, never bus-off",
         Is_At (N, Error_Passive, 0, 256));
      Count (N, Received);
      Facts.Check
        ("one good reception makes it active again",
         Is_At (N, Error_Active, 0, 127));
   end Check_Receiver;

   --------------------
   -- Check_Recovery --
   --------------------

   procedure Check_Recovery is
      use type Levels.Level;
      N, Interrupted : Node;
   begin
      Repeat (N, Receiver_Error, 5);
      Repeat (N, Transmitter_Error, 32);
      Facts.Check
        ("1407 recessive bits are not enough",
         Is_At (Listen (N, Levels.Recessive, 1407), Bus_Off, 256, 5));
      Facts.Check
        ("128 sequences of 11 recessive bits bring a node back",
         Is_At (Listen (N, Levels.Recessive, 1408), Error_Active, 0, 0));
      Facts.Check
        ("a dominant bus keeps it off",
         Is_At (Listen (N, Levels.Dominant, 5000), Bus_Off, 256, 5));
      Interrupted := Listen (N, Levels.Recessive, 11 * 127 + 10);
      Interrupted := Listen (Interrupted, Levels.Dominant, 3);
      Facts.Check
        ("a sequence that is cut short begins again, the others stay",
         Bits_To_Recovery (Interrupted) = 11
         and then State (Listen (Interrupted, Levels.Recessive, 10)) = Bus_Off
         and then
           State (Listen (Interrupted, Levels.Recessive, 11))
           = Error_Active);
   end Check_Recovery;

   ------------------------
   -- Check_Error_Frames --
   ------------------------

   procedure Check_Error_Frames is
      use type Levels.Level;
      Alone : constant Error_Frame :=
        (Kind => Stuff_Error, Role => Receiver,
         Flag => Flag_Of (Error_Active), Echo => 0);
      Late  : constant Error_Frame :=
        (Kind => Acknowledgement_Error, Role => Transmitter,
         Flag => Flag_Of (Error_Passive), Echo => 6);
   begin
      Facts.Check
        ("an error frame has 14 to 20 bits",
         Length (Alone) = 14 and then Length (Late) = 20);
      Facts.Check
        ("only an error-active node's flag is seen",
         Flag_Level (Alone.Flag) = Levels.Dominant
         and then Flag_Level (Late.Flag) = Levels.Recessive);
   end Check_Error_Frames;

begin
   Check_Transmitter;
   Check_Receiver;
   Check_Recovery;
   Check_Error_Frames;
   Facts.Finish;
end Test_Fault_Confinement;
