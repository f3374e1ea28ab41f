--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The records of a run: health counters, traces, monitors.

with Facts;
with Objects;
with Ravenchart.Health;
with Ravenchart.Queueing;
with Ravenchart.Recorded_Values;
with Ravenchart.Traces;

procedure Test_Records is
   use type Ravenchart.Element_Id;
   use type Ravenchart.Event_Count;
   use type Ravenchart.Nanoseconds;
   use type Ravenchart.Number;
   use type Ravenchart.Queueing.Take_Status;
   use type Ravenchart.Recorded_Values.Value_Record;
   use type Ravenchart.Traces.Trace_Kind;
   use type Ravenchart.Traces.Trace_Record;

   procedure Check_Counts;

   procedure Check_Trace;

   procedure Check_Large_Trace;

   procedure Check_Values;

   procedure Check_Monitor;

   ------------------
   -- Check_Counts --
   ------------------

   procedure Check_Counts is
      Counts : Ravenchart.Health.Fault_Counts;
      Others_Zero : Boolean := True;
   begin
      Objects.Counters.Record_Fault (Ravenchart.Health.Stale_Input);
      Objects.Counters.Record_Fault (Ravenchart.Health.Stale_Input);
      Objects.Counters.Read (Counts);
      for Kind in Ravenchart.Health.Fault_Kind loop
         if Kind not in Ravenchart.Health.Stale_Input then
            Others_Zero := Others_Zero and then Counts (Kind) = 0;
         end if;
      end loop;
      Facts.Check
        ("each fault has its own count",
         Counts (Ravenchart.Health.Stale_Input) = 2 and then Others_Zero);
      Facts.Check
        ("a count stays at its last value",
         Ravenchart.Next (Ravenchart.Event_Count'Last)
         = Ravenchart.Event_Count'Last);
   end Check_Counts;

   -----------------
   -- Check_Trace --
   -----------------

   procedure Check_Trace is
      Item    : Ravenchart.Traces.Trace_Record;
      Status  : Ravenchart.Queueing.Take_Status;
      Before  : Ravenchart.Nanoseconds := 0;
      Ordered : Boolean := True;
   begin
      for I in 1 .. 6 loop
         Objects.Trace.Note (Ravenchart.Traces.Raised, 100, I);
      end loop;
      for I in 1 .. 4 loop
         Objects.Trace.Take (Item, Status);
         Ordered := Ordered
           and then Status = Ravenchart.Queueing.Taken
           and then Item.Kind = Ravenchart.Traces.Raised
           and then Item.Element = 100
           and then Item.Value = I
           and then Item.At_Time >= Before;
         Before := Item.At_Time;
      end loop;
      Facts.Check ("a trace keeps order and time", Ordered);
      Facts.Check
        ("a full trace rejects and counts the newest",
         Objects.Trace.Lost = 2);
      Objects.Trace.Take (Item, Status);
      Facts.Check
        ("an empty trace says so",
         Status = Ravenchart.Queueing.Empty
         and then Item = Ravenchart.Traces.Null_Record);
   end Check_Trace;

   -----------------------
   -- Check_Large_Trace --
   -----------------------

   procedure Check_Large_Trace is
      Item   : Ravenchart.Traces.Trace_Record;
      Status : Ravenchart.Queueing.Take_Status;
      Count  : Natural := 0;
   begin
      for I in 1 .. 70_000 loop
         Objects.Large_Trace.Note (Ravenchart.Traces.Sent, 1, I);
      end loop;
      loop
         Objects.Large_Trace.Take (Item, Status);
         exit when Status = Ravenchart.Queueing.Empty;
         Count := Count + 1;
         exit when Item.Value /= Count;
      end loop;
      Facts.Check
        ("the largest trace holds 65536 records",
         Count = 65_536 and then Objects.Large_Trace.Lost = 4_464);
   end Check_Large_Trace;

   ------------------
   -- Check_Values --
   ------------------

   procedure Check_Values is
      Given : constant array (1 .. 6) of Ravenchart.Number :=
        (Ravenchart.Number'First, -1, 0, Ravenchart.Number'Last, 7, 8);

      Item    : Ravenchart.Recorded_Values.Value_Record;
      Status  : Ravenchart.Queueing.Take_Status;
      Before  : Ravenchart.Nanoseconds := 0;
      Ordered : Boolean := True;
   begin
      for Value of Given loop
         Objects.Values.Note (Value, 200);
      end loop;
      for I in 1 .. 4 loop
         Objects.Values.Take (Item, Status);
         Ordered := Ordered
           and then Status = Ravenchart.Queueing.Taken
           and then Item.Element = 200
           and then Item.Value = Given (I)
           and then Item.At_Time >= Before;
         Before := Item.At_Time;
      end loop;
      Facts.Check ("recorded values keep order, time and range", Ordered);
      Facts.Check
        ("a full buffer rejects and counts the newest value",
         Objects.Values.Lost = 2);
      Objects.Values.Take (Item, Status);
      Facts.Check
        ("an empty buffer says so",
         Status = Ravenchart.Queueing.Empty
         and then Item = Ravenchart.Recorded_Values.Null_Record);
   end Check_Values;

   -------------------
   -- Check_Monitor --
   -------------------

   procedure Check_Monitor is
      Observed : Objects.Monitor.Statistics;
   begin
      Objects.Monitor.Record_Release (10, False, (5, 0));
      Objects.Monitor.Record_Release (30, True, (4, 7));
      Objects.Monitor.Record_Release (20, False, (3, 6));
      Objects.Monitor.Read (Observed);
      Facts.Check
        ("a monitor counts releases and misses",
         Observed.Releases = 3 and then Observed.Misses = 1);
      Facts.Check
        ("a monitor keeps the last response and the worst times",
         Observed.Worst_Response = 30
         and then Observed.Last_Response = 20
         and then Observed.Worst_Execution (Objects.First_Job) = 5
         and then Observed.Worst_Execution (Objects.Second_Job) = 7);
   end Check_Monitor;

begin
   Check_Counts;
   Check_Trace;
   Check_Large_Trace;
   Check_Values;
   Check_Monitor;
   Facts.Finish;
end Test_Records;
