--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Values between two cores, as fast as both can: 100,000 of them for each
--  trial.

with Crossed;
with Facts;
with Ravenchart.Queueing;
with Trials;

procedure Test_Crossings
  with CPU => 1
is
   use type Ravenchart.Queueing.Put_Status;

   Values : constant Natural := Trials.Times * 100_000;

   procedure Put_All (Now : Crossed.Stage);

   procedure Check (Now : Crossed.Stage; Name : String);

   -------------
   -- Put_All --
   -------------

   procedure Put_All (Now : Crossed.Stage) is
      Status : Ravenchart.Queueing.Put_Status;
   begin
      for Number in 1 .. Values loop
         case Now is
            when Crossed.Of_Board =>
               Crossed.Board.Write ((others => Number));
            when Crossed.Of_Sample =>
               Crossed.Sample.Put ((others => Number));
            when Crossed.Of_Queue =>
               loop
                  Crossed.Queue.Put ((others => Number), Status);
                  exit when Status = Ravenchart.Queueing.Queued;
               end loop;
         end case;
      end loop;
      while Crossed.Done <= Crossed.Stage'Pos (Now) loop
         null;
      end loop;
   end Put_All;

   -----------
   -- Check --
   -----------

   procedure Check (Now : Crossed.Stage; Name : String) is
      Found : Crossed.Findings renames Crossed.Found (Now);
   begin
      Facts.Check ("no value is torn: " & Name, Found.Torn = 0);
      Facts.Check ("no value is older than one before: " & Name,
                   Found.Backwards = 0);
      Facts.Check ("both cores worked at once: " & Name,
                   Found.Different > Values / 1_000);
   end Check;

begin
   Crossed.Last := Values;
   for Now in Crossed.Stage loop
      Put_All (Now);
   end loop;
   Check (Crossed.Of_Board, "board");
   Check (Crossed.Of_Sample, "sample");
   Check (Crossed.Of_Queue, "queue");
   Facts.Check
     ("a queue leaves no value out", Crossed.Found (Crossed.Of_Queue).Left_Out
      = 0 and then Crossed.Found (Crossed.Of_Queue).Different = Values);
   Facts.Finish;
end Test_Crossings;
