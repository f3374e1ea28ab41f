--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The bus in virtual time: faults of the line and of nodes, and faults on
--  demand.

with Facts;
with Ravenchart.Can;
with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Buses;
with Ravenchart.Can.Fault_Plans;
with Ravenchart.Can.Line_Events;
with Ravenchart.Can.Networks;
with Simulated;

procedure Test_Bus_Faults is
   use Ravenchart;
   use Ravenchart.Can;
   use Ravenchart.Can.Bus_Nodes;
   use Ravenchart.Can.Line_Events;
   use Simulated;
   use type Bus_Faults.Fault_Kind;
   use type Bus_Frames.Bus_Frame;
   use type Buses.Ending;

   procedure Check_Line;

   procedure Check_Cut;

   procedure Check_Babble;

   procedure Check_Plans;

   procedure Check_Receivers;

   ----------------
   -- Check_Line --
   ----------------

   procedure Check_Line is
   begin
      Start (3);
      Send (1, Plain (5));
      Happen (Hold_Dominant);
      for I in 1 .. 100 loop
         Step;
      end loop;
      Facts.Check
        ("a dominant bus makes all passive, and nobody bus-off",
         State (1) = Error_Passive
         and then State (3) = Error_Passive
         and then not Networks.Next (Net).Known);
      Happen (Let_Go);
      Step;
      Facts.Check
        ("when it is let go, the frame is sent",
         Result.Sent (1) and then State (3) = Error_Active);

      Start (3);
      Send (1, Plain (5));
      Happen (Hold_Recessive);
      for I in 1 .. 100 loop
         Step;
      end loop;
      Facts.Check
        ("a recessive bus makes who sends bus-off, and nobody else",
         State (1) = Bus_Off
         and then State (2) = Error_Active
         and then Receive_Errors (2) = 0);
      Happen (Let_Go);
      Step;
      Facts.Check
        ("who is bus-off does nothing by itself",
         Result.Ended = Buses.Silence and then State (1) = Bus_Off);
      declare
         Before : constant Nanoseconds := Net.Bus.Free_At (1);
      begin
         Buses.Recover (Net.Bus, 1, Before);
         Step;
         Facts.Check
           ("after a request for recovery, it sends after 1408 bits",
            Result.Start = Before + 1408 * Bit and then Result.Sent (1));
      end;
   end Check_Line;

   ---------------
   -- Check_Cut --
   ---------------

   procedure Check_Cut is
      Whole : Natural := 0;
   begin
      Start (4);
      Happen (Cut, 4);
      Send (1, Plain (5));
      Send (4, Plain (6));
      for I in 1 .. 60 loop
         Step;
         if Result.Ended = Buses.Whole then
            Whole := Whole + 1;
            Facts.Check
              ("on a bus that is cut, those on one side hear each other",
               Result.Heard (2) and then not Result.Heard (4));
         end if;
      end loop;
      Facts.Check
        ("and who is alone is not heard",
         Whole = 1
         and then Networks.Waiting (Net, 4) = 1
         and then State (4) = Error_Passive);
      Happen (Mend);
      Step;
      Facts.Check
        ("mended, it is", Result.Sent (4) and then Result.Heard (1));
   end Check_Cut;

   ------------------
   -- Check_Babble --
   ------------------

   procedure Check_Babble is
      Alone : Boolean := True;
   begin
      Start (3);
      Happen (Babble, 3);
      Send (1, Plain (5));
      for I in 1 .. 50 loop
         Step;
         Alone := Alone and then Result.Winner = 3;
      end loop;
      Happen (Hush, 3);
      Step;
      Facts.Check
        ("who babbles keeps the others from the bus, until it is quiet",
         Alone and then Result.Sent (1));
   end Check_Babble;

   -----------------
   -- Check_Plans --
   -----------------

   procedure Check_Plans is
      Plan   : Fault_Plans.Plan;
      Again  : Fault_Plans.Plan;
      Fault  : Bus_Faults.Fault;
      Same   : Bus_Faults.Fault;
      Quiet  : Nanoseconds := 0;
      Errors : Natural := 0;
      Sound  : Boolean := True;
   begin
      Plan.Seed := 42;
      Plan.Separation := 1_000_000;
      Plan.Count := 1;
      Plan.Listed (1) :=
        (Frame => 3,
         Fault => (Kind => Bus_Faults.Dropped, others => <>));
      Again := Plan;
      Start (2);
      for I in 1 .. 200 loop
         if Networks.Waiting (Net, 1) = 0 then
            Send (1, Plain (5));
         end if;
         Fault_Plans.Draw (Plan, Net.Bus.Free_At (1), Fault);
         Fault_Plans.Draw (Again, Net.Bus.Free_At (1), Same);
         Sound := Sound
           and then Bus_Faults."=" (Fault, Same)
           and then (Fault.Kind = Bus_Faults.Dropped) = (I = 3);
         Step (Fault);
         if Result.Ended = Buses.Broken then
            Sound  := Sound and then Result.Struck >= Quiet;
            Quiet  := Result.Struck + 1_000_000;
            Errors := Errors + 1;
            Fault_Plans.Note (Plan, Result.Struck);
            Fault_Plans.Note (Again, Result.Struck);
         end if;
      end loop;
      Facts.Check
        ("a plan gives the same faults again, and keeps its distance",
         Sound and then Errors in 20 .. 60);
   end Check_Plans;

   ---------------------
   -- Check_Receivers --
   ---------------------

   procedure Check_Receivers is
      use Bus_Faults;
      Changed : constant Fault :=
        (Kind => Corrupted, Node => 2, Index => 1, Mask => 16#0F#,
         others => <>);
   begin
      Facts.Check
        ("a receiver may lose a frame, or have it twice, or late",
         Copies_For ((Kind => Dropped, others => <>), 2) = 0
         and then
           Copies_For ((Kind => Duplicated, Node => 2, others => <>), 2) = 2
         and then
           Copies_For ((Kind => Duplicated, Node => 2, others => <>), 3) = 1
         and then
           Lateness ((Kind => Delayed, Late => 7, others => <>), 3) = 7);
      Facts.Check
        ("or with changed data, and then it alone",
         As_Heard (Changed, 2, Plain (5, 16#1234#)) = Plain (5, 16#1D34#)
         and then
           As_Heard (Changed, 3, Plain (5, 16#1234#)) = Plain (5, 16#1234#));
   end Check_Receivers;

begin
   Check_Line;
   Check_Cut;
   Check_Babble;
   Check_Plans;
   Check_Receivers;
   Facts.Finish;
end Test_Bus_Faults;
