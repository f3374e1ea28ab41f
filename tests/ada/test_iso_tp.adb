--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  ISO-TP: transfers of all lengths between the two ends, with each kind of
--  flow control; the outcome of transfers with wrong, lost and late segments;
--  and arbitrary bytes.

with Facts;
with Interfaces;
with Ravenchart;
with Ravenchart.Can;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Iso_Tp;
with Ravenchart.Can.Iso_Tp.Receivers;
with Ravenchart.Can.Iso_Tp.Senders;
with Reassembled;

procedure Test_Iso_Tp is
   use Ravenchart.Can.Iso_Tp;
   use Ravenchart.Can.Iso_Tp.Receivers;
   use Ravenchart.Can.Iso_Tp.Senders;
   use type Ravenchart.Can.Fd_Frames.Fd_Bytes;
   use type Interfaces.Unsigned_32;
   use type Interfaces.Unsigned_64;
   use type Interfaces.Unsigned_8;
   use type Ravenchart.Event_Count;
   use type Ravenchart.Execution_Count;
   use type Ravenchart.Nanoseconds;

   Seed : Interfaces.Unsigned_32 := 2_463_534_242;

   function Drawn (Below : Positive) return Natural;
   --  A number from 0 on (xorshift, Marsaglia 2003).

   function Value_Of (Length : Value_Length) return Value_Bytes;
   --  A value of this length; 0 beyond it.

   type Link is record
      From     : Sender;
      To       : Receiver;
      Flow     : Flow_Notice;
      Now      : Ravenchart.Nanoseconds := 0;
      Segments : Natural := 0;
      Answers  : Natural := 0;
      Fault    : Transfer_Fault := None;
      Result   : Outcome := Ignored;
   end record;
   --  The two ends, and the outcome of the last execution.

   procedure Turn
     (Item : in out Link;
      S    : Senders.Setting;
      R    : Receivers.Setting;
      Code : Octet := 0;
      Lose : Boolean := False);
   --  One execution of the row, 1 ms long; the answer comes before the next
   --  one. Lose: the segment is lost.

   procedure Check_All_Lengths;

   procedure Check_Separation;

   procedure Check_Faults;

   procedure Check_Any_Bytes;

   procedure Check_Reassembly;

   -----------
   -- Drawn --
   -----------

   function Drawn (Below : Positive) return Natural is
   begin
      Seed := Seed xor Interfaces.Shift_Left (Seed, 13);
      Seed := Seed xor Interfaces.Shift_Right (Seed, 17);
      Seed := Seed xor Interfaces.Shift_Left (Seed, 5);
      return Natural (Seed mod Interfaces.Unsigned_32 (Below));
   end Drawn;

   --------------
   -- Value_Of --
   --------------

   function Value_Of (Length : Value_Length) return Value_Bytes is
      Result : Value_Bytes := (others => 0);
   begin
      for I in 0 .. Length - 1 loop
         Result (I) := Octet (Drawn (256));
      end loop;
      return Result;
   end Value_Of;

   ----------
   -- Turn --
   ----------

   procedure Turn
     (Item : in out Link;
      S    : Senders.Setting;
      R    : Receivers.Setting;
      Code : Octet := 0;
      Lose : Boolean := False)
   is
      Payload : Interfaces.Unsigned_64;
      Reply   : Answer;
      Found   : Segment;
   begin
      Item.Now    := Item.Now + 1_000_000;
      Item.Result := Ignored;
      Count (Item.From, S, Item.Flow, Item.Fault);
      if Is_Due (Item.From, S) then
         Payload := Next_Segment (Item.From, S);
         Record_Sent (Item.From, S);
         Item.Segments := Item.Segments + 1;
         if Lose then
            return;
         end if;
         Take (Item.To, R, Payload, 8, Item.Now, Item.Result, Reply);
         if Reply /= No_Answer then
            Found :=
              Decoded
                (Flow_Payload
                   ((if Reply = Refuse then Overflow else Continue_To_Send),
                    R.Block,
                    Code),
                 8);
            Item.Answers := Item.Answers + 1;
            Item.Flow    :=
              (Item.Flow.Count + 1, Found.Status, Found.Block,
               Found.Separation);
         end if;
      end if;
   end Turn;

   -----------------------
   -- Check_All_Lengths --
   -----------------------

   procedure Check_All_Lengths is
      Wrong, Slow, Unasked : Natural := 0;
   begin
      for Length in Value_Length loop
         for Block in Block_Size range 0 .. 10 loop
            for Distance in Turns range 1 .. 3 loop
               declare
                  S : constant Senders.Setting :=
                    (Length, Distance, 10, 0, 1_000);
                  R : constant Receivers.Setting :=
                    (Length, Block, 50_000_000, 60_000_000);
                  V : constant Value_Bytes := Value_Of (Length);
                  L : Link;
                  --  The number of segments that follow the first one.
                  More   : constant Natural :=
                    (if Length <= 7 then 0 else (Length - 6 + 6) / 7);
                  Rounds : constant Natural :=
                    (if More = 0 then 0
                     elsif Block = 0 then 1
                     else (More + Block - 1) / Block);
                  Taken_Turns : Natural := 0;
               begin
                  Give (L.From, V);
                  loop
                     Turn (L, S, R);
                     Taken_Turns := Taken_Turns + 1;
                     exit when L.Result = Complete or else Taken_Turns > 99;
                  end loop;
                  if L.To.Data /= V or else L.Fault /= None then
                     Wrong := Wrong + 1;
                  end if;
                  if Taken_Turns /= 1 + More * Natural (Distance) then
                     Slow := Slow + 1;
                  end if;
                  if L.Answers /= Rounds or else L.Segments /= More + 1 then
                     Unasked := Unasked + 1;
                  end if;
               end;
            end loop;
         end loop;
      end loop;
      Facts.Check
        ("values of every length arrive, whatever the blocks:" & Wrong'Image,
         Wrong = 0);
      Facts.Check
        ("one segment goes in each Distance executions:" & Slow'Image,
         Slow = 0);
      Facts.Check
        ("flow control comes once for each block:" & Unasked'Image,
         Unasked = 0);
   end Check_All_Lengths;

   ----------------------
   -- Check_Separation --
   ----------------------

   procedure Check_Separation is
      S : constant Senders.Setting := (64, 1, 10, 0, 1_000);
      R : constant Receivers.Setting := (64, 0, 50_000_000, 60_000_000);
      L : Link;
      Last, Turn_Number : Natural := 0;
      Least : Natural := Natural'Last;
   begin
      Facts.Check
        ("codes of the separation time are those of the standard",
         Separation_Of (0) = 0
         and then Separation_Of (16#7F#) = 127_000
         and then Separation_Of (16#F1#) = 100
         and then Separation_Of (16#F9#) = 900
         and then Separation_Of (16#80#) = 127_000
         and then Separation_Of (16#FF#) = 127_000);
      Give (L.From, Value_Of (64));
      for I in 1 .. 60 loop
         declare
            Before : constant Natural := L.Segments;
         begin
            Turn (L, S, R, Code => 3);
            Turn_Number := Turn_Number + 1;
            if L.Segments > Before then
               if L.Segments > 2 then
                  Least := Natural'Min (Least, Turn_Number - Last);
               end if;
               Last := Turn_Number;
            end if;
         end;
      end loop;
      Facts.Check
        ("3 ms apart on a row of 1 ms are four executions, for its jitter:"
         & Least'Image, Least = 4 and then L.Segments = 10);
   end Check_Separation;

   ------------------
   -- Check_Faults --
   ------------------

   procedure Check_Faults is
      S : constant Senders.Setting := (19, 1, 5, 1, 1_000);
      R : constant Receivers.Setting := (19, 0, 3_000_000, 4_000_000);
      L : Link;
      V : constant Value_Bytes := Value_Of (19);

      procedure Begin_Anew;
      --  A transfer whose first segment has gone and been answered.

      procedure Begin_Anew is
      begin
         L := (others => <>);
         Give (L.From, V);
         Turn (L, S, R);
      end Begin_Anew;

      Turns_Waited : Natural := 0;
   begin
      Give (L.From, V);
      Turn (L, S, R, Lose => True);
      loop
         Turn (L, S, R);
         Turns_Waited := Turns_Waited + 1;
         exit when L.Fault /= None or else Turns_Waited > 20;
      end loop;
      Facts.Check
        ("a silent receiver ends the transfer after the time-out:"
         & Turns_Waited'Image,
         L.Fault = Timed_Out
         and then Turns_Waited = 6
         and then L.From.Phase = Idle);
      Give (L.From, V);
      for I in 1 .. 3 loop
         Turn (L, S, R);
      end loop;
      Facts.Check
        ("the next value is sent all the same",
         L.Result = Complete and then L.To.Data = V);

      Begin_Anew;
      L.Flow.Status := Overflow;
      Turn (L, S, R);
      Facts.Check
        ("a receiver without room ends it", L.Fault = Overflowed);

      Begin_Anew;
      L.Flow.Status := Wait;
      Turn (L, S, R);
      Facts.Check ("one may ask to wait", L.Fault = None);
      L.Flow.Count := L.Flow.Count + 1;
      Turn (L, S, R);
      Facts.Check
        ("not more often than Waits", L.Fault = Waited_Too_Often);

      Begin_Anew;
      L.Flow.Status := Invalid;
      Turn (L, S, R);
      Facts.Check ("a reserved status ends it", L.Fault = Wrong_Flow);

      Begin_Anew;
      Turn (L, S, R, Lose => True);
      Turn (L, S, R);
      Facts.Check
        ("a lost segment is noticed by the next one",
         L.Result = Wrong_Sequence and then not L.To.Is_Open);

      Begin_Anew;
      L.Now := L.Now + 4_000_000;
      Turn (L, S, R);
      Facts.Check
        ("a segment that comes too late ends the value",
         L.Result = Receivers.Timed_Out and then not L.To.Is_Open);

      Begin_Anew;
      declare
         Early, Late, Again : Boolean;
         Last : constant Ravenchart.Nanoseconds := L.To.Last;
      begin
         Give_Up (L.To, R, Last + R.Patience, Early);
         Give_Up (L.To, R, Last + R.Patience + 1, Late);
         Give_Up (L.To, R, Last + R.Patience + 2, Again);
         Facts.Check
           ("no segment ends the value when patience is over, once",
            not Early and then Late and then not Again);
         Turn (L, S, R);
         Facts.Check
           ("a segment that comes after all is none of a value",
            L.Result = Ignored and then not L.To.Is_Open);
      end;

      Begin_Anew;
      L.From := (others => <>);
      Give (L.From, V);
      Turn (L, S, R);
      Facts.Check
        ("a first segment begins a new value, and the old one counts",
         L.Result = Restarted);
      for I in 1 .. 2 loop
         Turn (L, S, R);
      end loop;
      Facts.Check
        ("which arrives", L.Result = Complete and then L.To.Data = V);

      declare
         Longer  : constant Senders.Setting := (20, 1, 5, 1, 1_000);
         Shorter : constant Senders.Setting := (18, 1, 5, 1, 1_000);
      begin
         L := (others => <>);
         Give (L.From, V);
         Turn (L, Longer, R);
         Facts.Check
           ("a longer value is refused",
            L.Result = Wrong_Length
            and then L.Flow.Status = Overflow
            and then L.Answers = 1);
         L := (others => <>);
         Give (L.From, V);
         Turn (L, Shorter, R);
         Facts.Check
           ("a shorter one is not answered",
            L.Result = Wrong_Length and then L.Answers = 0);
      end;
   end Check_Faults;

   ---------------------
   -- Check_Any_Bytes --
   ---------------------

   procedure Check_Any_Bytes is
      R      : Receivers.Setting := (64, 3, 5_000_000, 6_000_000);
      To     : Receiver;
      From   : Sender;
      Flow   : Flow_Notice;
      Result : Outcome;
      Reply  : Answer;
      Now    : Ravenchart.Nanoseconds := 0;
      Fault  : Transfer_Fault;
      Wrong  : Natural := 0;
      Found  : Segment;
   begin
      for Round in 1 .. 200_000 loop
         R.Length := 1 + Drawn (64);
         declare
            Head    : constant Natural := Drawn (5);
            Payload : constant Interfaces.Unsigned_64 :=
              (Interfaces.Shift_Left
                 (Interfaces.Unsigned_64 (Drawn (2**24)), 8)
               or Interfaces.Unsigned_64
                    (if Head = 4 then Drawn (256)
                     elsif Head = 2
                     then 16#20# + Natural (To.Sequence)
                     else 16 * Head + Drawn (2)));
            Before  : constant Receiver := To;
            S       : constant Senders.Setting :=
              (R.Length, 1 + Ravenchart.Execution_Count (Drawn (3)), 3, 1,
               Row_Period (1 + Drawn (2_000)));
         begin
            Now := Now + Ravenchart.Nanoseconds (Drawn (3_000_000));
            Take (To, R, Payload, Drawn (9), Now, Result, Reply);
            if Result = Complete and then To.Got /= R.Length then
               Wrong := Wrong + 1;
            end if;
            if Result in Ignored .. Ignored and then To.Data /= Before.Data
            then
               Wrong := Wrong + 1;
            end if;
            Found := Decoded (Payload, Drawn (9));
            if Found.Kind = Flow_Control then
               Flow :=
                 (Flow.Count + 1, Found.Status, Found.Block,
                  Found.Separation);
            end if;
            if Drawn (4) = 0 then
               Give (From, Value_Of (R.Length));
            end if;
            Count (From, S, Flow, Fault);
            if Is_Due (From, S) then
               Found := Decoded (Next_Segment (From, S), 8);
               if Found.Kind not in Single .. Consecutive then
                  Wrong := Wrong + 1;
               end if;
               Record_Sent (From, S);
            end if;
         end;
      end loop;
      Facts.Check
        ("any bytes leave both ends sound:" & Wrong'Image, Wrong = 0);
   end Check_Any_Bytes;

   ----------------------
   -- Check_Reassembly --
   ----------------------

   procedure Check_Reassembly is
      use type Reassembled.Flow_Request;

      S       : constant Senders.Setting := (19, 1, 5, 1, 1_000);
      Longer  : constant Senders.Setting := (20, 1, 5, 1, 1_000);
      V       : constant Value_Bytes := Value_Of (19);
      From    : Sender;
      Flow    : Flow_Notice;
      Fault   : Transfer_Fault;
      Now     : Ravenchart.Nanoseconds := 0;
      Result  : Outcome := Ignored;
      Got     : Value_Bytes;
      Wanted  : Reassembled.Flow_Request;
      Expired : array (1 .. 3) of Boolean;

      procedure Begin_Anew (S : Senders.Setting; V : Value_Bytes);
      --  A new sender has given its first segment.

      procedure Begin_Anew (S : Senders.Setting; V : Value_Bytes) is
      begin
         From := (others => <>);
         Give (From, V);
         while not Is_Due (From, S) loop
            Count (From, S, Flow, Fault);
         end loop;
         Reassembled.Take (Next_Segment (From, S), 8, Now, Result);
      end Begin_Anew;

   begin
      Give (From, V);
      for Turn in 1 .. 20 loop
         Now := Now + 1_000_000;
         Count (From, S, Flow, Fault);
         if Is_Due (From, S) then
            Reassembled.Take (Next_Segment (From, S), 8, Now, Result);
            Record_Sent (From, S);
            Reassembled.Look (Now, Wanted, Expired (1));
            Flow := (Wanted.Count, Wanted.Status, 1, 0);
         end if;
         exit when Result = Complete;
      end loop;
      Reassembled.Read (Got);
      Facts.Check
        ("the object of a reassembly asks for each segment once",
         Result = Complete
         and then Got = V
         and then Wanted = (2, Continue_To_Send));

      Begin_Anew (Longer, Value_Of (20));
      Reassembled.Look (Now, Wanted, Expired (1));
      Facts.Check
        ("it refuses a longer value",
         Result = Wrong_Length and then Wanted = (3, Overflow));

      Begin_Anew (S, V);
      Reassembled.Look (Now + 4_000_000, Wanted, Expired (1));
      Reassembled.Look (Now + 4_000_001, Wanted, Expired (2));
      Reassembled.Look (Now + 4_000_002, Wanted, Expired (3));
      Facts.Check
        ("it tells once that a transfer was given up",
         Result = Taken
         and then Wanted = (4, Continue_To_Send)
         and then not Expired (1)
         and then Expired (2)
         and then not Expired (3));
   end Check_Reassembly;

begin
   Check_All_Lengths;
   Check_Separation;
   Check_Faults;
   Check_Any_Bytes;
   Check_Reassembly;
   Facts.Finish;
end Test_Iso_Tp;
