--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Calls of another node: one waits, late and repeated frames are recognised.
--  A read value is the last one that came, and its age is reported once.

with Facts;
with Objects;
with Ravenchart.Calls;
with Ravenchart.Queueing;

procedure Test_Calls is
   use type Ravenchart.Number;
   use type Ravenchart.Calls.Hearing;
   use type Ravenchart.Calls.Reply_Status;
   use type Ravenchart.Calls.Wait_Status;
   use type Ravenchart.Queueing.Put_Status;

   procedure Check_Caller;

   procedure Check_Limit;

   procedure Check_Provider;

   procedure Check_Reader;

   procedure Check_Turns;

   ------------------
   -- Check_Caller --
   ------------------

   procedure Check_Caller is
      First, Second : Ravenchart.Calls.Call_Number;
      Put           : Ravenchart.Queueing.Put_Status;
      Reply         : Ravenchart.Calls.Reply_Status;
   begin
      Objects.Calling.Finish (255, Reply);
      Facts.Check
        ("before the first call no reply is awaited",
         Reply = Ravenchart.Calls.Late);
      Objects.Calling.Start (First, Put);
      Facts.Check
        ("the first call has the number 0",
         Put = Ravenchart.Queueing.Queued and then First = 0);
      Objects.Calling.Start (Second, Put);
      Facts.Check
        ("a second call finds the first under way",
         Put = Ravenchart.Queueing.Rejected_Full);
      Objects.Calling.Finish (First + 1, Reply);
      Facts.Check
        ("a reply with another number is none",
         Reply = Ravenchart.Calls.Late);
      Objects.Calling.Finish (First, Reply);
      Facts.Check
        ("the reply to the call is awaited",
         Reply = Ravenchart.Calls.Awaited);
      Objects.Calling.Finish (First, Reply);
      Facts.Check
        ("the same reply is not awaited again",
         Reply = Ravenchart.Calls.Late);
   end Check_Caller;

   -----------------
   -- Check_Limit --
   -----------------

   procedure Check_Limit is
      Old, Number : Ravenchart.Calls.Call_Number;
      Put         : Ravenchart.Queueing.Put_Status;
      Reply       : Ravenchart.Calls.Reply_Status;
      Wait        : Ravenchart.Calls.Wait_Status;
      Waits       : Boolean := True;
      Counts      : Boolean := True;
   begin
      Objects.Calling.Start (Old, Put);
      for Execution in 1 .. Objects.Call_Limit - 1 loop
         Objects.Calling.Tick (Wait);
         Waits := Waits and then Wait = Ravenchart.Calls.Within_Limit;
      end loop;
      Facts.Check ("a call waits until its limit", Waits);
      Objects.Calling.Tick (Wait);
      Facts.Check
        ("at its limit it is given up", Wait = Ravenchart.Calls.Timed_Out);
      Objects.Calling.Tick (Wait);
      Facts.Check
        ("that is told once", Wait = Ravenchart.Calls.Within_Limit);
      Objects.Calling.Start (Number, Put);
      Objects.Calling.Finish (Old, Reply);
      Facts.Check
        ("a late reply is not taken for that of the next call",
         Put = Ravenchart.Queueing.Queued
         and then Reply = Ravenchart.Calls.Late);
      Objects.Calling.Finish (Number, Reply);
      for Call in 1 .. 256 loop
         Old := Number;
         Objects.Calling.Start (Number, Put);
         Counts := Counts and then Number = (Old + 1) mod 256;
         Objects.Calling.Finish (Number, Reply);
         Counts := Counts and then Reply = Ravenchart.Calls.Awaited;
      end loop;
      Facts.Check ("numbers go round", Counts);
   end Check_Limit;

   --------------------
   -- Check_Provider --
   --------------------

   procedure Check_Provider is
      Heard   : Ravenchart.Calls.Heard;
      Hearing : Ravenchart.Calls.Hearing;
   begin
      Ravenchart.Calls.Hear (Heard, 0, Hearing);
      Facts.Check
        ("the first call is heard, whatever its number",
         Hearing = Ravenchart.Calls.Heard_First);
      Ravenchart.Calls.Hear (Heard, 0, Hearing);
      Facts.Check
        ("the same frame is heard once", Hearing = Ravenchart.Calls.Repeated);
      Ravenchart.Calls.Hear (Heard, 2, Hearing);
      Facts.Check
        ("a call after one that was lost is heard",
         Hearing = Ravenchart.Calls.Heard_First);
   end Check_Provider;

   ------------------
   -- Check_Reader --
   ------------------

   procedure Check_Reader is
      Wait : Ravenchart.Calls.Wait_Status;
      Item : Integer;
      Told : Natural := 0;
   begin
      Objects.Reading.Read (Item);
      Facts.Check ("before the first value the initial one is read",
         Item = -1);
      for Execution in 1 .. Objects.Call_Limit - 1 loop
         Objects.Reading.Tick (Wait);
         Facts.Check
           ("the first value may take its limit",
            Wait = Ravenchart.Calls.Within_Limit);
      end loop;
      Objects.Reading.Tick (Wait);
      Facts.Check
        ("without one it is too old at its limit",
         Wait = Ravenchart.Calls.Timed_Out);
      Objects.Reading.Put (7);
      for Execution in 1 .. 3 * Objects.Call_Limit loop
         Objects.Reading.Tick (Wait);
         Told := Told + (if Wait = Ravenchart.Calls.Timed_Out then 1 else 0);
         Facts.Check
           ("it is told at the limit after the last value",
            (Wait = Ravenchart.Calls.Timed_Out)
            = (Execution = Objects.Call_Limit));
      end loop;
      Objects.Reading.Read (Item);
      Facts.Check ("it is told once", Told = 1);
      Facts.Check ("the last value stays", Item = 7);
   end Check_Reader;

   -----------------
   -- Check_Turns --
   -----------------

   procedure Check_Turns is
      Left : Ravenchart.Execution_Count := 0;
      Due  : Boolean;
   begin
      for Execution in 0 .. 6 loop
         Ravenchart.Calls.Take_Turn (Left, Every => 3, Is_Due => Due);
         Facts.Check
           ("the first execution sends, and every third behind it",
            Due = (Execution mod 3 = 0));
      end loop;
      Ravenchart.Calls.Take_Turn (Left, Every => 1, Is_Due => Due);
      Ravenchart.Calls.Take_Turn (Left, Every => 1, Is_Due => Due);
      Ravenchart.Calls.Take_Turn (Left, Every => 1, Is_Due => Due);
      Facts.Check ("each execution sends when every one does", Due);
   end Check_Turns;

begin
   Check_Caller;
   Check_Limit;
   Check_Provider;
   Check_Reader;
   Check_Turns;
   Facts.Finish;
end Test_Calls;
