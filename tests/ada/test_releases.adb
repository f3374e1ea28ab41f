--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The mailbox of a port that releases a processor: its content, the task that
--  it wakes, and the releases in real time. The machine may be busy: the facts
--  hold however late a task runs.

with Ada.Real_Time;
with Facts;
with Ravenchart.Epochs;
with Ravenchart.Queueing;
with Released;

procedure Test_Releases is
   use type Ada.Real_Time.Time;
   use type Ada.Real_Time.Time_Span;
   use type Ravenchart.Event_Count;
   use type Ravenchart.Queueing.Put_Status;
   use type Ravenchart.Queueing.Take_Status;

   Values : constant := 20_000;

   procedure Check_Mailbox;

   procedure Check_Processor;

   -------------------
   -- Check_Mailbox --
   -------------------

   procedure Check_Mailbox is
      package Newest renames Released.Newest;
      Put   : Ravenchart.Queueing.Put_Status;
      Taken : Ravenchart.Queueing.Take_Status;
      Value : Natural;
   begin
      Facts.Check ("a mailbox is empty at first", Newest.Is_Empty);
      for Item in 1 .. 2 loop
         Newest.Put (Item, Put);
         Facts.Check
           ("it holds as many as its depth",
            Put = Ravenchart.Queueing.Queued);
      end loop;
      Newest.Wait;
      Facts.Check ("who waits leaves the value there", not Newest.Is_Empty);
      Newest.Put (3, Put);
      Facts.Check
        ("a full one drops the oldest where its policy says so",
         Put = Ravenchart.Queueing.Dropped_Oldest and then Newest.Lost = 1);
      Newest.Wait;
      Newest.Take (Value, Taken);
      Facts.Check
        ("the oldest that is left is taken first",
         Value = 2 and then Taken = Ravenchart.Queueing.Taken);
      Newest.Take (Value, Taken);
      Facts.Check
        ("then the next one", Value = 3 and then Newest.Is_Empty);
      Newest.Take (Value, Taken);
      Facts.Check
        ("of an empty one nothing is taken",
         Value = 0 and then Taken = Ravenchart.Queueing.Empty);
   end Check_Mailbox;

   ---------------------
   -- Check_Processor --
   ---------------------

   procedure Check_Processor is
      Pause    : constant Ada.Real_Time.Time_Span :=
        Ada.Real_Time.Microseconds (20);
      Limit    : constant Ada.Real_Time.Time :=
        Ravenchart.Epochs.Start + Ada.Real_Time.Seconds (60);
      Status   : Ravenchart.Queueing.Put_Status;
      Observed : Released.Processor.Statistics;
      Refused  : Ravenchart.Event_Count := 0;
      Number   : Natural := 0;
   begin
      while Number < Values and then Ada.Real_Time.Clock < Limit loop
         Released.Mailbox.Put (Number + 1, Status);
         if Status = Ravenchart.Queueing.Queued then
            Number := Number + 1;
         else
            Refused := Refused + 1;
            delay until Ada.Real_Time.Clock + Pause;
         end if;
      end loop;
      while Released.Log.Handled < Number
        and then Ada.Real_Time.Clock < Limit
      loop
         delay until Ada.Real_Time.Clock + Ada.Real_Time.Milliseconds (1);
      end loop;
      delay until Ada.Real_Time.Clock + Ada.Real_Time.Milliseconds (20);
      Facts.Check
        ("each value releases the processor once",
         Number = Values and then Released.Log.Handled = Values);
      Released.Processor.Observe (Observed);
      Facts.Check
        ("its releases are counted",
         Observed.Releases = Ravenchart.Event_Count (Values));
      Facts.Check ("in the order in which they came", Released.Log.In_Order);
      Facts.Check
        ("no two releases are closer than the separation",
         Released.Log.Last_At - Ravenchart.Epochs.Start
         >= (Values - 1) * Ada.Real_Time.Nanoseconds (Released.Separation));
      Facts.Check
        ("a value that found no room is counted",
         Released.Mailbox.Lost = Refused);
   end Check_Processor;

begin
   Check_Mailbox;
   Check_Processor;
   Facts.Finish;
end Test_Releases;
