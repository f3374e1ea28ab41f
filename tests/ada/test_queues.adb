--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The queue behind every protected queue, beside a model of it: every
--  sequence of operations up to a length, for each small capacity.

with Facts;
with Objects;
with Ravenchart.Queueing;

procedure Test_Queues is
   use type Ravenchart.Event_Count;
   use type Ravenchart.Queueing.Put_Status;
   use type Ravenchart.Queueing.Take_Status;

   package Plain renames Objects.Plain;

   Longest : constant := 9;
   --  Operations in a sequence.

   type Operation is (Put_Or_Reject, Put_Or_Drop, Take);

   subtype Count is Natural range 0 .. Longest;

   type Elements is array (1 .. Longest) of Integer;

   type Model is record
      Items   : Elements := (others => 0);
      First   : Count := 0;
      Last    : Count := 0;
      Highest : Count := 0;
      Lost    : Ravenchart.Event_Count := 0;
   end record;
   --  Items holds all that was queued; First .. Last, without First, wait.

   function Agrees (Q : Plain.Queue; M : Model) return Boolean
   is (Plain.Length (Q) = M.Last - M.First
       and then Plain.Highest (Q) = M.Highest
       and then Plain.Lost (Q) = M.Lost);

   function Put_Agrees
     (Q     : in out Plain.Queue;
      M     : in out Model;
      Item  : Integer;
      Drops : Boolean) return Boolean;
   --  Put Item into both, and compare.

   function Take_Agrees
     (Q : in out Plain.Queue; M : in out Model) return Boolean;
   --  Take an element from both, and compare.

   function Sequence_Agrees (Code : Natural; Capacity : Count) return Boolean;
   --  Each digit of Code to the base 3 is an operation.

   procedure Check_Capacity (Capacity : Count);

   ----------------
   -- Put_Agrees --
   ----------------

   function Put_Agrees
     (Q     : in out Plain.Queue;
      M     : in out Model;
      Item  : Integer;
      Drops : Boolean) return Boolean
   is
      use Ravenchart.Queueing;
      Wanted : Put_Status := Queued;
      Status : Put_Status;
   begin
      if M.Last - M.First = Q.Capacity then
         M.Lost := M.Lost + 1;
         Wanted := (if Drops then Dropped_Oldest else Rejected_Full);
      end if;
      if Wanted = Dropped_Oldest then
         M.First := M.First + 1;
      end if;
      if Wanted /= Rejected_Full then
         M.Last := M.Last + 1;
         M.Items (M.Last) := Item;
      end if;
      M.Highest := Count'Max (M.Highest, M.Last - M.First);
      Plain.Put
        (Q, Item, (if Drops then Drop_Oldest else Reject_Newest), Status);
      return Status = Wanted and then Agrees (Q, M);
   end Put_Agrees;

   -----------------
   -- Take_Agrees --
   -----------------

   function Take_Agrees
     (Q : in out Plain.Queue; M : in out Model) return Boolean
   is
      Status : Ravenchart.Queueing.Take_Status;
      Item   : Integer;
      Wanted : Integer := 0;
      Empty  : constant Boolean := M.First = M.Last;
   begin
      if not Empty then
         M.First := M.First + 1;
         Wanted := M.Items (M.First);
      end if;
      Plain.Take (Q, Item, Status);
      return Item = Wanted
        and then (Status = Ravenchart.Queueing.Empty) = Empty
        and then Agrees (Q, M);
   end Take_Agrees;

   ---------------------
   -- Sequence_Agrees --
   ---------------------

   function Sequence_Agrees (Code : Natural; Capacity : Count) return Boolean
   is
      Q    : Plain.Queue (Capacity);
      M    : Model;
      Rest : Natural := Code;
      Same : Boolean := Agrees (Q, M);
   begin
      for Item in 1 .. Longest loop
         case Operation'Val (Rest mod 3) is
            when Put_Or_Reject =>
               Same := Same and then Put_Agrees (Q, M, Item, Drops => False);
            when Put_Or_Drop =>
               Same := Same and then Put_Agrees (Q, M, Item, Drops => True);
            when Take =>
               Same := Same and then Take_Agrees (Q, M);
         end case;
         Rest := Rest / 3;
      end loop;
      while M.First < M.Last loop
         Same := Same and then Take_Agrees (Q, M);
         exit when not Same;
      end loop;
      return Same;
   end Sequence_Agrees;

   --------------------
   -- Check_Capacity --
   --------------------

   procedure Check_Capacity (Capacity : Count) is
      Same : Boolean := True;
   begin
      for Code in 0 .. 3 ** Longest - 1 loop
         Same := Same and then Sequence_Agrees (Code, Capacity);
      end loop;
      Facts.Check
        ("a queue of" & Capacity'Image & " does what its model does", Same);
   end Check_Capacity;

begin
   for Capacity in 1 .. 4 loop
      Check_Capacity (Capacity);
   end loop;
   Facts.Finish;
end Test_Queues;
