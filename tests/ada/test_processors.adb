--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Periodic and sporadic processors in real time. The machine may be busy: the
--  facts hold however late a task runs.

with Ada.Real_Time;
with Facts;
with Ravenchart.Epochs;
with Ravenchart.Queueing;
with Workload;

procedure Test_Processors is
   use type Ada.Real_Time.Time;
   use type Ada.Real_Time.Time_Span;
   use type Ravenchart.Event_Count;
   use type Ravenchart.Nanoseconds;
   use type Workload.Job;

   Releases : constant := 50;

   procedure Wait_Until_Done;

   procedure Check_Cyclic;

   procedure Check_Late;

   procedure Check_Sporadic;

   ---------------------
   -- Wait_Until_Done --
   ---------------------

   procedure Wait_Until_Done is
      Poll  : constant Ada.Real_Time.Time_Span :=
        Ada.Real_Time.Milliseconds (5);
      Limit : constant Ada.Real_Time.Time :=
        Ravenchart.Epochs.Start + Ada.Real_Time.Seconds (10);
      Next  : Ada.Real_Time.Time :=
        Ravenchart.Epochs.Start + Ada.Real_Time.Milliseconds (500);
      Done  : Workload.Cyclic.Statistics;
      Late  : Workload.Late.Statistics;
      Woken : Workload.Sporadic.Statistics;
   begin
      loop
         delay until Next;
         Workload.Cyclic.Observe (Done);
         Workload.Late.Observe (Late);
         Workload.Sporadic.Observe (Woken);
         exit when Next > Limit
           or else (Done.Releases >= Releases
                    and then Late.Releases >= Releases
                    and then Woken.Releases >= 5);
         Next := Next + Poll;
      end loop;
   end Wait_Until_Done;

   ------------------
   -- Check_Cyclic --
   ------------------

   procedure Check_Cyclic is
      Observed : Workload.Cyclic.Statistics;
      Step     : constant Ada.Real_Time.Time_Span :=
        Ravenchart.Epochs.To_Span (Workload.Period);
      Due      : Ada.Real_Time.Time :=
        Ravenchart.Epochs.Start + Ada.Real_Time.Milliseconds (2);
      Before   : constant Ada.Real_Time.Time := Ada.Real_Time.Clock;
      Position : Positive := 1;
      Item     : Workload.Entry_Record;
      Order    : Boolean := True;
      Early    : Boolean := False;
      Least    : Ada.Real_Time.Time_Span := Ada.Real_Time.Time_Span_Last;
      Limit    : Ravenchart.Event_Count;
   begin
      Workload.Cyclic.Observe (Observed);
      Limit := Ravenchart.Event_Count
        (Ravenchart.Epochs.To_Nanoseconds
           (Ada.Real_Time.Clock - Due) / Workload.Period + 1);
      Facts.Check
        ("a periodic processor has run 50 releases and none too many",
         Observed.Releases in Releases .. Limit
         and then Before > Due);
      for Release in 0 .. Releases - 1 loop
         Item  := Workload.Cyclic_Log.Item (Position);
         Order := Order and then Item.What = Workload.Each_Release;
         Early := Early or else Item.At_Time < Due;
         if Release >= Releases - 10 and then Item.At_Time - Due < Least then
            Least := Item.At_Time - Due;
         end if;
         Position := Position + 1;
         if Release mod 2 = 1 then
            Item     := Workload.Cyclic_Log.Item (Position);
            Order    := Order and then Item.What = Workload.Each_Other;
            Position := Position + 1;
         end if;
         Due := Due + Step;
      end loop;
      Facts.Check ("activities run by the table and in its order", Order);
      Facts.Check ("no release runs before it is due", not Early);
      Facts.Check ("releases do not drift", Least < Step);
      Facts.Check
        ("every activity that ran was measured",
         (for all Time of Observed.Worst_Execution =>
            Time in 1 .. 10_000_000_000));
      Facts.Check
        ("a response was measured", Observed.Worst_Response > 0);
   end Check_Cyclic;

   ----------------
   -- Check_Late --
   ----------------

   procedure Check_Late is
      Observed : Workload.Late.Statistics;
      Noted    : constant Natural := Workload.Missed_Log.Count;
      Item     : Workload.Entry_Record;
   begin
      Workload.Late.Observe (Observed);
      Facts.Check
        ("a late release is run late, none is dropped",
         Observed.Releases >= Releases);
      Facts.Check
        ("work of 3.5 periods makes three releases miss",
         Observed.Misses >= 3);
      Facts.Check
        ("each miss is reported once",
         Noted >= 3
         and then Ravenchart.Event_Count (Noted) <= Observed.Misses);
      Facts.Check
        ("the worst response covers the work",
         Observed.Worst_Response >= 35_000_000);
      Item := Workload.Overrun_Log.Item (1);
      Facts.Check
        ("an activity's processor time is told when it ends, and only then",
         Workload.Overrun_Log.Count = 1
         and then Item.What = Workload.Each_Release
         and then Item.Value >= 35);
      Facts.Check
        ("processor time is charged to the activity that used it",
         Observed.Worst_Execution (Workload.Each_Release) >= 35_000_000
         and then
           Observed.Worst_Execution (Workload.Each_Other) < 35_000_000);
   end Check_Late;

   --------------------
   -- Check_Sporadic --
   --------------------

   procedure Check_Sporadic is
      Observed : Workload.Sporadic.Statistics;
      Before   : Workload.Entry_Record;
      Item     : Workload.Entry_Record;
      Order    : Boolean := True;
      First    : Ada.Real_Time.Time;
   begin
      Workload.Sporadic.Observe (Observed);
      Facts.Check
        ("a sporadic processor runs once for each request",
         Observed.Releases = 5 and then Workload.Sporadic_Log.Count = 10);
      First := Workload.Sporadic_Log.Item (1).At_Time;
      Facts.Check
        ("no sporadic release comes before the common start",
         First >= Ravenchart.Epochs.Start);
      for Release in 1 .. 5 loop
         Before := Workload.Sporadic_Log.Item (2 * Release - 1);
         Item   := Workload.Sporadic_Log.Item (2 * Release);
         Order  := Order
           and then Before.Value = Release
           and then Item.Value = Release
           and then Before.What = Workload.Each_Release
           and then Item.What = Workload.Each_Other;
      end loop;
      Facts.Check ("requests are served in order, by all activities", Order);
      Item := Workload.Sporadic_Log.Item (9);
      Facts.Check
        ("five requests at once take four separations",
         Item.At_Time - Ravenchart.Epochs.Start
         >= Ada.Real_Time.Milliseconds (80));
   end Check_Sporadic;

   Status : Ravenchart.Queueing.Put_Status;

begin
   for Request in 1 .. 5 loop
      Workload.Requests.Put (Request, Status);
   end loop;
   Wait_Until_Done;
   Check_Cyclic;
   Check_Late;
   Check_Sporadic;
   Facts.Finish;
end Test_Processors;
