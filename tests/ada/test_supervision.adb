--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Silence of a processor, by all small cases and in real time. The machine
--  may be busy: the facts hold however late a task runs. With the argument
--  "wait" the main program never ends the process.

with Ada.Command_Line;
with Ada.Real_Time;
with Facts;
with Ravenchart.Epochs;
with Ravenchart.Failures;
with Ravenchart.Liveness;
with Ravenchart.Queueing;
with Supervised;

procedure Test_Supervision is
   use type Ada.Real_Time.Time;
   use type Ravenchart.Event_Count;
   use type Ravenchart.Liveness.Finding;
   use type Ravenchart.Nanoseconds;
   use all type Supervised.Processor;

   procedure Check_All_Small_Cases;
   --  Compare with a count of the releases that should have completed.

   procedure Check_Large_Cases;

   procedure Await_Stuck;
   --  Wait until the endless loop is found. The first one found gets the
   --  lowest priority: otherwise two of these programs would take two cores
   --  for ever, where they may use real-time priorities.

   procedure Check_Findings;

   ---------------------------
   -- Check_All_Small_Cases --
   ---------------------------

   procedure Check_All_Small_Cases is
      Agrees : Boolean := True;
      Least  : Natural;
   begin
      for Offset in 0 .. 4 loop
         for Period in 1 .. 4 loop
            for Limit in 1 .. 6 loop
               for Elapsed in 0 .. 20 loop
                  Least := 0;
                  while Offset + Least * Period + Limit <= Elapsed loop
                     Least := Least + 1;
                  end loop;
                  for Completed in 0 .. 22 loop
                     Agrees := Agrees
                       and then (Completed < Least)
                         = Ravenchart.Liveness.Is_Silent
                             ((Offset => Ravenchart.Nanoseconds (Offset),
                               Period => Ravenchart.Nanoseconds (Period),
                               Limit  => Ravenchart.Nanoseconds (Limit)),
                              (Completed => Ravenchart.Event_Count (Completed),
                               others    => <>),
                              Ravenchart.Nanoseconds (Elapsed));
                  end loop;
               end loop;
            end loop;
         end loop;
      end loop;
      Facts.Check ("silent is who has completed less than was due", Agrees);
   end Check_All_Small_Cases;

   -----------------------
   -- Check_Large_Cases --
   -----------------------

   procedure Check_Large_Cases is
      Last     : constant Ravenchart.Nanoseconds :=
        Ravenchart.Nanoseconds'Last;
      Reported : Boolean := False;
      First    : Ravenchart.Liveness.Finding;
      Second   : Ravenchart.Liveness.Finding;
      Third    : Ravenchart.Liveness.Finding;
   begin
      Facts.Check
        ("the largest values are judged as well",
         not Ravenchart.Liveness.Is_Silent
           ((Last, Last, Last), (0, False, 0), Last)
         and then not Ravenchart.Liveness.Is_Silent
           ((0, 1, 1), (Ravenchart.Event_Count'Last, False, 0), Last)
         and then Ravenchart.Liveness.Is_Silent
           ((0, 1, 1), (Ravenchart.Event_Count'Last - 1, False, 0), Last)
         and then Ravenchart.Liveness.Is_Stuck (1, (0, True, 0), Last)
         and then Ravenchart.Liveness.Is_Stuck (Last, (0, True, 0), Last)
         and then not Ravenchart.Liveness.Is_Stuck (Last, (0, True, 1), Last)
         and then not Ravenchart.Liveness.Is_Stuck (1, (0, False, 0), Last));
      Ravenchart.Liveness.Note (Reported, False, First);
      Ravenchart.Liveness.Note (Reported, True, Second);
      Ravenchart.Liveness.Note (Reported, True, Third);
      Facts.Check
        ("silence is reported once",
         First = Ravenchart.Liveness.In_Time
         and then Second = Ravenchart.Liveness.Falls_Silent
         and then Third = Ravenchart.Liveness.Was_Silent);
   end Check_Large_Cases;

   -----------------
   -- Await_Stuck --
   -----------------

   procedure Await_Stuck is
      Next : Ada.Real_Time.Time := Ravenchart.Epochs.Start;
      Seen : Supervised.Finding_Table;
   begin
      for Turn in 1 .. 10_000 loop
         Seen := Supervised.Findings.All_Of_Them;
         exit when Seen (Watch_Stuck).Times > 0;
         Next := Next + Ada.Real_Time.Milliseconds (10);
         delay until Next;
      end loop;
   end Await_Stuck;

   --------------------
   -- Check_Findings --
   --------------------

   procedure Check_Findings is
      Seen : constant Supervised.Finding_Table :=
        Supervised.Findings.All_Of_Them;
      Due  : constant Ravenchart.Nanoseconds :=
        2_000_000
        + Ravenchart.Nanoseconds (Seen (Watch_Stuck).Before)
          * Supervised.Period;
      Fed  : Ravenchart.Event_Count;
      Stop : Boolean;
   begin
      Facts.Check
        ("an endless loop is found once, with five releases completed",
         Seen (Watch_Stuck).Times = 1 and then Seen (Watch_Stuck).Before = 5);
      Facts.Check
        ("it is found when deadline and margin are over, and not before",
         Seen (Watch_Stuck).Found >= Due + Supervised.Limit);
      Facts.Check
        ("a sporadic release that never ends is found once",
         Seen (Watch_Served).Times = 1
         and then Seen (Watch_Served).Before = 1);
      Facts.Check
        ("who completes its releases is not found",
         Seen (Watch_Healthy).Times = 0
         or else Ravenchart.Nanoseconds (Seen (Watch_Healthy).Before)
                 * Supervised.Period + Supervised.Limit_Of_Healthy
                 <= Seen (Watch_Healthy).Found);
      Supervised.Supervisor.Read (Fed);
      Facts.Check
        ("the watchdog was fed until the first silence",
         Fed > 0
         and then Ravenchart.Nanoseconds (Fed)
                  <= Ravenchart.Nanoseconds'Min
                       (Seen (Watch_Stuck).Found, Seen (Watch_Served).Found)
                     / Supervised.Period + 1);
      Stop := Ravenchart.Failures.Stop_Needed;
      Facts.Check ("the program is to stop", Stop);
   end Check_Findings;

   Status : Ravenchart.Queueing.Put_Status;

begin
   Check_All_Small_Cases;
   Check_Large_Cases;
   Await_Stuck;
   for Request in 1 .. 2 loop
      Supervised.Requests.Put (Request, Status);
   end loop;
   delay until Ravenchart.Epochs.Start + Ada.Real_Time.Milliseconds (800);
   Check_Findings;
   if Ada.Command_Line.Argument_Count > 0 then
      delay until Ada.Real_Time.Time_Last;
   end if;
   Facts.Finish;
end Test_Supervision;
