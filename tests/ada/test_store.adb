--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Queues and blackboards: order, overflow and fill, and the reports and
--  reactions of offers.

with Facts;
with Objects;
with Ravenchart.Health;
with Ravenchart.Queueing;

procedure Test_Store is
   use type Ravenchart.Event_Count;
   use type Ravenchart.Queueing.Fill;
   use type Ravenchart.Queueing.Put_Status;
   use type Ravenchart.Queueing.Take_Status;

   type Wanted_Items is array (Positive range <>) of Integer;

   procedure Check_Rejecting;

   procedure Check_Dropping;

   procedure Check_Offers;

   procedure Check_Board;

   ---------------------
   -- Check_Rejecting --
   ---------------------

   procedure Check_Rejecting is
      Put   : Ravenchart.Queueing.Put_Status;
      Take  : Ravenchart.Queueing.Take_Status;
      Item  : Integer;
      Right : Boolean := True;
   begin
      for I in 1 .. 5 loop
         Objects.Rejecting.Put (I, Put);
         Right := Right
           and then Put = (if I <= 3 then Ravenchart.Queueing.Queued
                           else Ravenchart.Queueing.Rejected_Full);
      end loop;
      Facts.Check ("a full queue rejects the newest", Right);
      Facts.Check
        ("a queue counts what it rejects", Objects.Rejecting.Lost = 2);
      Right := True;
      for I in 1 .. 3 loop
         Objects.Rejecting.Take (Item, Take);
         Right := Right
           and then Take = Ravenchart.Queueing.Taken
           and then Item = I;
      end loop;
      Facts.Check ("a queue that rejected keeps its order", Right);
      Objects.Rejecting.Take (Item, Take);
      Facts.Check
        ("an empty queue says so and gives its null element",
         Take = Ravenchart.Queueing.Empty and then Item = -1);
   end Check_Rejecting;

   --------------------
   -- Check_Dropping --
   --------------------

   procedure Check_Dropping is
      Put   : Ravenchart.Queueing.Put_Status;
      Take  : Ravenchart.Queueing.Take_Status;
      Item  : Integer;
      Fill  : Ravenchart.Queueing.Fill;
      Right : Boolean := True;
   begin
      Facts.Check ("a queue is empty at first", Objects.Dropping.Is_Empty);
      for I in 1 .. 5 loop
         Objects.Dropping.Put (I, Put);
         Right := Right
           and then Put = (if I <= 3 then Ravenchart.Queueing.Queued
                           else Ravenchart.Queueing.Dropped_Oldest);
      end loop;
      Facts.Check ("a full queue can drop the oldest", Right);
      Facts.Check ("a queue counts what it drops", Objects.Dropping.Lost = 2);
      for I in 3 .. 5 loop
         Objects.Dropping.Take (Item, Take);
         Right := Right
           and then Take = Ravenchart.Queueing.Taken
           and then Item = I;
         Objects.Dropping.Read_Fill (Fill);
         Right := Right
           and then Fill = (Now => 5 - I, Highest => 3)
           and then Objects.Dropping.Is_Empty = (I = 5);
      end loop;
      Facts.Check ("a queue that dropped keeps order and fill", Right);
   end Check_Dropping;

   ------------------
   -- Check_Offers --
   ------------------

   procedure Check_Offers is

      function Overflows return Ravenchart.Event_Count;

      function Holds
        (First : Integer; Second : Integer; Third : Integer) return Boolean;
      --  Takes three elements from the queue with policy Drop_Oldest.

      ---------------
      -- Overflows --
      ---------------

      function Overflows return Ravenchart.Event_Count is
         Counts : Ravenchart.Health.Fault_Counts;
      begin
         Objects.Counters.Read (Counts);
         return Counts (Ravenchart.Health.Queue_Overflow);
      end Overflows;

      -----------
      -- Holds --
      -----------

      function Holds
        (First : Integer; Second : Integer; Third : Integer) return Boolean
      is
         Item : Integer;
         Take : Ravenchart.Queueing.Take_Status;
         Same : Boolean := True;
      begin
         for Wanted of Wanted_Items'(First, Second, Third) loop
            Objects.Dropping.Take (Item, Take);
            Same := Same
              and then Take = Ravenchart.Queueing.Taken
              and then Item = Wanted;
         end loop;
         return Same;
      end Holds;

      Lost : Boolean;
   begin
      for I in 1 .. 3 loop
         Objects.Rejecting_Offers.Offer (I);
      end loop;
      Facts.Check ("what is queued is no fault", Overflows = 0);
      Objects.Rejecting_Offers.Offer (4);
      Facts.Check ("a loss is reported once", Overflows = 1);
      Objects.Rejecting_Offers.Offer_And_Tell (5, Lost);
      Facts.Check ("a loss is told", Lost and then Overflows = 2);
      Objects.Dropping_Offers.Offer (1);
      Objects.Dropping_Offers.Offer_And_Tell (2, Lost);
      Facts.Check ("no loss is told as none", not Lost);
      Objects.Answered.Offer (6);
      Facts.Check
        ("a loss is reported and answered once",
         Overflows = 3 and then Holds (1, 2, 99));
      for I in 1 .. 3 loop
         Objects.Dropping_Offers.Offer (I);
      end loop;
      Objects.Answered.Offer (7);
      Facts.Check
        ("what an answer loses is reported and not answered",
         Overflows = 5 and then Holds (2, 3, 99));
      Objects.Answered.Offer (8, Ravenchart.Queueing.Drop_Oldest);
      Facts.Check
        ("an element may have a policy of its own",
         Overflows = 6);
   end Check_Offers;

   -----------------
   -- Check_Board --
   -----------------

   procedure Check_Board is
      Item : Integer;
   begin
      Objects.Board.Read (Item);
      Facts.Check ("a blackboard begins with its initial value", Item = 42);
      Objects.Board.Write (1);
      Objects.Board.Write (2);
      Objects.Board.Read (Item);
      Facts.Check ("a blackboard keeps the last value", Item = 2);
      Objects.Board.Read (Item);
      Facts.Check ("reading a blackboard changes nothing", Item = 2);
   end Check_Board;

begin
   Check_Rejecting;
   Check_Dropping;
   Check_Offers;
   Check_Board;
   Facts.Finish;
end Test_Store;
