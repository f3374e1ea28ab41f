--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Queues, blackboards and the buffer behind them: order and overflow.

with Facts;
with Objects;
with Ravenchart.Queueing;

procedure Test_Store is
   use type Ravenchart.Event_Count;
   use type Ravenchart.Queueing.Put_Status;
   use type Ravenchart.Queueing.Take_Status;

   procedure Check_Fifo;

   procedure Check_Rejecting;

   procedure Check_Dropping;

   procedure Check_Board;

   ----------------
   -- Check_Fifo --
   ----------------

   procedure Check_Fifo is
      Queue : Objects.Fifos.Fifo (Capacity => 3);
      Item  : Integer;
      Order : Boolean := True;
   begin
      Facts.Check ("a new fifo is empty", Objects.Fifos.Length (Queue) = 0);
      for Round in 1 .. 100 loop
         Objects.Fifos.Put (Queue, 2 * Round);
         Objects.Fifos.Put (Queue, 2 * Round + 1);
         Order := Order and then Objects.Fifos.Length (Queue) = 2;
         Objects.Fifos.Get (Queue, Item);
         Order := Order and then Item = 2 * Round;
         Objects.Fifos.Get (Queue, Item);
         Order := Order and then Item = 2 * Round + 1;
      end loop;
      Facts.Check ("a fifo keeps its order while it wraps", Order);
      for I in 1 .. 3 loop
         Objects.Fifos.Put (Queue, I);
      end loop;
      Facts.Check ("a fifo can be filled", Objects.Fifos.Length (Queue) = 3);
      for I in 1 .. 3 loop
         Objects.Fifos.Get (Queue, Item);
         Order := Order and then Item = I;
      end loop;
      Facts.Check ("a full fifo gives back what was put", Order);
   end Check_Fifo;

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
      Right : Boolean := True;
   begin
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
      end loop;
      Facts.Check ("a queue that dropped keeps its order", Right);
   end Check_Dropping;

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
   Check_Fifo;
   Check_Rejecting;
   Check_Dropping;
   Check_Board;
   Facts.Finish;
end Test_Store;
