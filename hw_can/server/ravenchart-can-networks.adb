--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Networks
  with SPARK_Mode
is

   function Later (A, B : Nanoseconds) return Nanoseconds
   is (if A < B then B else A)
   with Global => null;
   --  The later of two.

   function Start_Of (N : Network; I : Node_Index) return Nanoseconds
   with
     Global => null,
     Post   =>
       Start_Of'Result >= N.Bus.Free_At (N.Bus.Nodes (I).Segment);
   --  The time of the next action of node I; the last of all times if there is
   --  none.

   --------------
   -- Start_Of --
   --------------

   function Start_Of (N : Network; I : Node_Index) return Nanoseconds is
      Node : constant Bus_Node := N.Bus.Nodes (I);
      Free : constant Nanoseconds := N.Bus.Free_At (Node.Segment);
   begin
      if Is_Held (N, I) then
         return Free;
      elsif N.Bus.Line = Buses.Held_Dominant then
         return Nanoseconds'Last;
      elsif Takes_Part (Node) and then N.Bus.Called (Node.Segment) then
         return Free;
      elsif Takes_Part (Node) and then N.Babble (I).Present then
         return Later (Free, Node.Ready_At);
      elsif Takes_Part (Node) and then Waiting (N, I) > 0 then
         return
           Later
             (Later (Free, Node.Ready_At), Head (N, I).Since);
      elsif Comes_Back (Node)
        and then Later (Free, Node.Ready_At) <= Buses.Last_Start
      then
         return
           Later (Free, Node.Ready_At)
           + Nanoseconds
               (Fault_Confinement.Bits_To_Recovery (Node.Confinement))
             * N.Bus.Times.Nominal;
      else
         return Nanoseconds'Last;
      end if;
   end Start_Of;

   ------------
   -- Offers --
   ------------

   function Offers (N : Network) return Buses.Offer_List is
      Result : Buses.Offer_List := N.Babble;
   begin
      for I in Node_Index loop
         if not N.Babble (I).Present and then Waiting (N, I) > 0 then
            Result (I) :=
              (Frame => Head (N, I).Frame, Present => True);
         end if;
         pragma Loop_Invariant
           (for all J in Node_Index =>
              (if J > I or else N.Babble (J).Present
               then Result (J) = N.Babble (J)
               else
                 Result (J).Present = (Waiting (N, J) > 0)
                 and then
                   (if Waiting (N, J) > 0
                    then Result (J).Frame = Head (N, J).Frame)));
      end loop;
      return Result;
   end Offers;

   ------------
   -- Submit --
   ------------

   procedure Submit
     (N      : in out Network;
      I      : Node_Index;
      Item   : Transmit_Buffers.Request;
      Status : out Send_Status) is
   begin
      if Waiting (N, I) < Transmit_Buffers.Room then
         Transmit_Buffers.Put (N.Buffers (I), Item);
         Status := Queued;
      else
         Status := Rejected_Full;
      end if;
   end Submit;

   --------------
   -- Withdraw --
   --------------

   procedure Withdraw (N : in out Network; I : Node_Index) is
   begin
      Transmit_Buffers.Clear (N.Buffers (I));
   end Withdraw;

   ----------
   -- Next --
   ----------

   function Next (N : Network) return Moment is
      Result : Moment;
   begin
      for I in Node_Index loop
         declare
            This : constant Nanoseconds := Start_Of (N, I);
         begin
            if This < Nanoseconds'Last
              and then (not Result.Known or else This < Result.Start)
            then
               Result :=
                 (Known   => True,
                  Segment => N.Bus.Nodes (I).Segment,
                  Start   => This);
            end if;
         end;
         pragma Loop_Invariant
           (if Result.Known
            then Result.Start >= N.Bus.Free_At (Result.Segment));
      end loop;
      return Result;
   end Next;

   ----------
   -- Step --
   ----------

   procedure Step
     (N        : in out Network;
      M        : Moment;
      Fault    : Bus_Faults.Fault;
      Result   : out Buses.Outcome;
      Receipts : out Receipt_List)
   is
      Offered : constant Buses.Offer_List := Offers (N);
   begin
      Receipts := (others => <>);
      Buses.Pass (N.Bus, M.Segment, M.Start);
      Buses.Contest
        (N.Bus, M.Segment, M.Start, Offered, Fault, Result);
      for I in Node_Index loop
         if Result.Sent (I) and then not N.Babble (I).Present then
            Receipts (I) :=
              (Tag   => Head (N, I).Tag,
               Since => Head (N, I).Since);
            Transmit_Buffers.Drop_Head (N.Buffers (I));
         end if;
         pragma Loop_Invariant
           (for all J in Node_Index =>
              (if J > I then N.Buffers (J) = N.Buffers'Loop_Entry (J)));
         pragma Loop_Invariant
           (for all J in 1 .. I =>
              (if Result.Sent (J) and then not N.Babble (J).Present
               then Waiting (N, J) = Waiting (N'Loop_Entry, J) - 1
                 and then Receipts (J).Tag = Head (N'Loop_Entry, J).Tag
               else N.Buffers (J) = N.Buffers'Loop_Entry (J)));
      end loop;
   end Step;

end Ravenchart.Can.Networks;
