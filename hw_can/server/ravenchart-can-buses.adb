--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Buses.Frame_Outcomes;
with Ravenchart.Can.Fault_Confinement;

package body Ravenchart.Can.Buses
  with SPARK_Mode
is
   use Frame_Outcomes;
   use type Bus_Frames.Bus_Frame_Family;
   use type Error_Frames.Error_Flag;
   use type Error_Frames.Error_Frame;

   After_Dominant : constant := 11;
   --  Recessive bits from the delimiter of the acknowledgement, or of an
   --  error, to the end of the intermission.

   Passive_Flag : constant := 6;
   --  The recessive bits of a passive error flag.

   Intermission : constant := 3;

   Suspended : constant := 8;
   --  The bits of suspend transmission.

   Held_Period : constant := 8;
   --  Dominant bits after which a node increments its counter again.

   procedure Conclude
     (B     : in out Bus;
      S     : Segment;
      Roles : Role_List;
      Quiet : Nanoseconds;
      Noisy : Boolean)
   with
     Global => null,
     Pre    => B.Free_At (S) <= Nanoseconds'Last - Bus_Frames.Longest_Time,
     Post   =>
       B.Times = B.Times'Old
       and then B.Line = B.Line'Old
       and then B.Free_At = B.Free_At'Old
       and then
         (for all N in Node_Index =>
            (if B.Nodes'Old (N).Segment /= S and then Roles (N) = Outside
             then B.Nodes (N) = B.Nodes'Old (N)));
   --  End the activity when the segment is free. Error-passive senders suspend
   --  transmission. Bus-off nodes count Quiet recessive bits, after dominant
   --  ones where Noisy.

   procedure Carry
     (B      : in out Bus;
      S      : Segment;
      Now    : Start_Time;
      Offers : Offer_List;
      Fault  : Bus_Faults.Fault;
      Roles  : Role_List;
      Winner : Node_Index;
      Result : in out Outcome)
   with
     Global => null,
     Pre    =>
       B.Free_At (S) = Now
       and then Result.Start = Now
       and then Fits (Roles, B, S)
       and then Roles (Winner) = Sender,
     Post   =>
       Is_Same_Beyond (B, B'Old, S)
       and then Is_In_Time (Result, Now, B.Free_At (S))
       and then Result.Winner = Winner
       and then Result.Frame = Offers (Winner).Frame
       and then Result.Ended /= Silence
       and then
         (for all N in Node_Index =>
            (if Result.Sent (N)
             then Roles (N) = Sender
               and then Offers (N).Frame = Result.Frame)
            and then
              (if Result.Heard (N)
               then Roles (N) /= Outside and then not Result.Sent (N)))
       and then
         (if Result.Ended = Whole
          then Result.Sent (Winner)
            and then
              (for all N in Node_Index =>
                 (if Roles (N) /= Outside
                    and then not Result.Sent (N)
                    and then
                      not Bus_Faults.Is_Witness (Fault, Positive (N))
                  then Result.Heard (N))));
   --  Transmit the frame of the winner on a sound line.

   procedure False_Start
     (B : in out Bus; S : Segment; Now : Start_Time; Roles : Role_List)
   with
     Global => null,
     Pre    => B.Free_At (S) = Now and then Fits (Roles, B, S),
     Post   =>
       Is_Same_Beyond (B, B'Old, S) and then Now <= B.Free_At (S);
   --  A start of frame without a frame: the sixth recessive bit after it is a
   --  stuff error for all nodes.

   procedure Hold (B : in out Bus; S : Segment; Now : Start_Time)
   with
     Global => null,
     Pre    => B.Free_At (S) = Now,
     Post   =>
       Is_Same_Beyond (B, B'Old, S) and then Now <= B.Free_At (S);
   --  A dominant bus: each node that begins to send loses arbitration, so that
   --  all are receivers, and count.

   procedure Fail
     (B      : in out Bus;
      S      : Segment;
      Now    : Start_Time;
      Offers : Offer_List;
      Result : in out Outcome)
   with
     Global => null,
     Pre    =>
       B.Free_At (S) = Now
       and then Result =
         (Outcome'(Start => Now, Finish => Now, Struck => Now,
                   others => <>)),
     Post   =>
       Is_Same_Beyond (B, B'Old, S)
       and then Is_In_Time (Result, Now, B.Free_At (S))
       and then
         (for all N in Node_Index =>
            not Result.Sent (N) and then not Result.Heard (N))
       and then Result.Ended /= Whole
       and then
         (if Result.Ended /= Silence
          then Contends (B'Old, Result.Winner, S, Now, Offers)
            and then Offers (Result.Winner).Frame = Result.Frame);
   --  A recessive bus: each node that begins to send reads its first bit back
   --  as recessive, and the bits of its error flag as well.

   ----------
   -- Pass --
   ----------

   procedure Pass (B : in out Bus; S : Segment; Now : Nanoseconds) is
      Bits : constant Nanoseconds := (Now - B.Free_At (S)) / B.Times.Nominal;
   begin
      B.Free_At (S) := Now;
      for N in Node_Index loop
         if B.Nodes (N).Segment = S and then B.Line /= Held_Dominant then
            Rest
              (B.Nodes (N),
               Quiet_Bits (B.Nodes (N), Now, Bits, B.Times.Nominal));
         end if;
         pragma Loop_Invariant
           (for all M in Node_Index =>
              Is_Same_But_Counts (B.Nodes (M), B.Nodes'Loop_Entry (M))
              and then
                (if M > N
                   or else B.Nodes'Loop_Entry (M).Segment /= S
                   or else not Comes_Back (B.Nodes'Loop_Entry (M))
                 then B.Nodes (M) = B.Nodes'Loop_Entry (M)));
      end loop;
   end Pass;

   --------------
   -- Conclude --
   --------------

   procedure Conclude
     (B     : in out Bus;
      S     : Segment;
      Roles : Role_List;
      Quiet : Nanoseconds;
      Noisy : Boolean) is
   begin
      for N in Node_Index loop
         if Roles (N) = Sender then
            if Is_Passive (B.Nodes (N)) then
               B.Nodes (N).Ready_At :=
                 B.Free_At (S) + Suspended * B.Times.Nominal;
            end if;
            if B.Nodes (N).Restart > 0 then
               Request_Recovery
                 (B.Nodes (N), B.Free_At (S) + B.Nodes (N).Restart);
            end if;
         elsif B.Nodes (N).Segment = S and then Roles (N) = Outside then
            if Noisy then
               Interrupt (B.Nodes (N));
            end if;
            Rest
              (B.Nodes (N),
               Quiet_Bits
                 (B.Nodes (N), B.Free_At (S), Quiet, B.Times.Nominal));
         end if;
         pragma Loop_Invariant
           (for all M in Node_Index =>
              (if M > N
                 or else
                   (B.Nodes'Loop_Entry (M).Segment /= S
                    and then Roles (M) = Outside)
               then B.Nodes (M) = B.Nodes'Loop_Entry (M)));
      end loop;
   end Conclude;

   -------------
   -- Recover --
   -------------

   procedure Recover (B : in out Bus; N : Node_Index; Now : Nanoseconds) is
      Node : Bus_Node renames B.Nodes (N);
      Free : constant Nanoseconds := B.Free_At (Node.Segment);
   begin
      Request_Recovery (Node, Now);
      if Comes_Back (Node)
        and then Node.Ready_At = Now
        and then Now < Free
        and then B.Line /= Held_Dominant
      then
         Rest
           (Node, Quiet_Bits (Node, Free, After_Dominant, B.Times.Nominal));
      end if;
   end Recover;

   -----------
   -- Carry --
   -----------

   procedure Carry
     (B      : in out Bus;
      S      : Segment;
      Now    : Start_Time;
      Offers : Offer_List;
      Fault  : Bus_Faults.Fault;
      Roles  : Role_List;
      Winner : Node_Index;
      Result : in out Outcome)
   is
      Before : constant Node_List := B.Nodes with Ghost;
      Frame  : constant Bus_Frames.Bus_Frame := Offers (Winner).Frame;
      Image  : constant Wire.Image := Bus_Frames.Image_Of (Frame);
      Found  : Disturbance;
      After  : Aftermath;
   begin
      pragma Assert
        (for all N in Node_Index =>
           (if Before (N).Segment /= S
            then not Listens (B, N, S) and then Roles (N) = Outside));
      Result.Winner := Winner;
      Result.Frame  := Frame;
      if Frame.Family = Bus_Frames.Asked_Error then
         Result.Ended  := Whole;
         Result.Sent   := (others => False);
         for N in Node_Index loop
            Result.Heard (N) := Roles (N) /= Outside and then N /= Winner;
            pragma Loop_Invariant
              (for all M in 1 .. N =>
                 Result.Heard (M)
                 = (Roles (M) /= Outside and then M /= Winner));
         end loop;
         Result.Sent (Winner) := True;
         Result.Struck := Now;
         Result.Finish :=
           Now + Nanoseconds (Error_Frames.Length (Result.Error))
                * B.Times.Nominal;
         B.Free_At (S) := Result.Finish + Intermission * B.Times.Nominal;
         B.Called (S) := False;
         pragma Assert
           (Result.Struck in Now .. Result.Finish
            and then Result.Finish <= B.Free_At (S));
         Conclude (B, S, Roles, After_Dominant, Noisy => True);
         return;
      end if;

      Find (B, Offers, Roles, Winner, Fault, Image, Found);
      if Found.Kind = Undisturbed then
         Result.Ended  := Whole;
         Result.Struck := Now;
         After := Behind (Roles, Fault, Image);
         pragma Assert
           (Nanoseconds (After.Bits) * B.Times.Nominal
            <= 40 * B.Times.Nominal);
         Result.Overload := After.Overload;
         Result.Finish := Now
           + Bus_Frames.Time_Until
               (Image, Bus_Frames.Rate_Of (Frame),
                Image.Ends (Wire.End_Of_Frame), B.Times);
         B.Free_At (S) :=
           Result.Finish + Nanoseconds (After.Bits) * B.Times.Nominal;
         pragma Assert
           (Result.Struck in Now .. Result.Finish
            and then Result.Finish <= B.Free_At (S));
      else
         Result.Ended    := Broken;
         Result.Position := Found.Position;
         Result.Struck := Now
           + Bus_Frames.Time_Until
               (Image, Bus_Frames.Rate_Of (Frame), Found.Position, B.Times);
         Result.Error := Error_Of (Roles, Fault, Found, Image);
         Result.Finish := Result.Struck
           + Nanoseconds (Error_Frames.Length (Result.Error))
             * B.Times.Nominal;
         B.Free_At (S) :=
           Result.Finish + Intermission * B.Times.Nominal;
         pragma Assert
           (Result.Struck in Now .. Result.Finish
            and then Result.Finish <= B.Free_At (S));
      end if;
      B.Called (S) := After.Called;
      Count_Outcome
        (B.Nodes, Roles, Fault, Found, Result.Sent, Result.Heard);
      if After.False_Start then
         Count_Stuff_Error (B.Nodes, Roles, But => Fault.Node);
      end if;
      pragma Assert
        (for all N in Node_Index =>
           (if Before (N).Segment /= S then B.Nodes (N) = Before (N)));
      pragma Assert
        (for all N in Node_Index =>
           (if Result.Ended = Whole
              and then Roles (N) /= Outside
              and then not Result.Sent (N)
              and then not Bus_Faults.Is_Witness (Fault, Positive (N))
            then Result.Heard (N)));
      Conclude
        (B, S, Roles,
         (if Found.Kind /= Undisturbed
            and then Result.Error.Flag = Error_Frames.Passive_Flag
          then Passive_Flag + After_Dominant
          elsif After.Called
          then After_Dominant - 1
          else After_Dominant),
         Noisy => True);
   end Carry;

   -----------------
   -- False_Start --
   -----------------

   procedure False_Start
     (B : in out Bus; S : Segment; Now : Start_Time; Roles : Role_List)
   is
      Stuff_Error : constant := 7;
      Frame       : Error_Frames.Error_Frame;
   begin
      B.Called (S)  := False;
      B.Free_At (S) := Now
        + (Stuff_Error + Nanoseconds (Error_Frames.Length (Frame))
           + Intermission)
          * B.Times.Nominal;
      Count_Stuff_Error (B.Nodes, Roles, But => 0);
      Conclude (B, S, Roles, After_Dominant, Noisy => True);
   end False_Start;

   ----------
   -- Hold --
   ----------

   procedure Hold (B : in out Bus; S : Segment; Now : Start_Time) is
   begin
      B.Called (S)  := False;
      B.Free_At (S) := Now + Held_Period * B.Times.Nominal;
      for N in Node_Index loop
         if Listens (B, N, S) then
            Count (B.Nodes (N), Fault_Confinement.Receiver_Held_Dominant);
         elsif B.Nodes (N).Segment = S then
            Interrupt (B.Nodes (N));
         end if;
         pragma Loop_Invariant
           (for all M in Node_Index =>
              (if M > N or else B.Nodes'Loop_Entry (M).Segment /= S
               then B.Nodes (M) = B.Nodes'Loop_Entry (M)));
      end loop;
   end Hold;

   ----------
   -- Fail --
   ----------

   procedure Fail
     (B      : in out Bus;
      S      : Segment;
      Now    : Start_Time;
      Offers : Offer_List;
      Result : in out Outcome)
   is
      Roles : Role_List := (others => Outside);
   begin
      for N in Node_Index loop
         if Contends (B, N, S, Now, Offers) then
            Roles (N)     := Sender;
            Result.Ended  := Broken;
            Result.Winner := N;
            Result.Frame  := Offers (N).Frame;
            Count (B.Nodes (N), Fault_Confinement.Transmitter_Error);
            if Takes_Part (B.Nodes (N))
              and then not Is_Passive (B.Nodes (N))
            then
               Count
                 (B.Nodes (N), Fault_Confinement.Transmitter_Flag_Error);
            end if;
         end if;
         pragma Loop_Invariant
           (for all M in Node_Index =>
              (if M > N or else B.Nodes'Loop_Entry (M).Segment /= S
               then B.Nodes (M) = B.Nodes'Loop_Entry (M)
                 and then Roles (M) = Outside));
         pragma Loop_Invariant
           (for all M in Node_Index =>
              Is_Same_But_Counts (B.Nodes (M), B.Nodes'Loop_Entry (M)));
         pragma Loop_Invariant
           (if Result.Ended /= Silence
            then Contends (B'Loop_Entry, Result.Winner, S, Now, Offers)
              and then Offers (Result.Winner).Frame = Result.Frame);
         pragma Loop_Invariant (Result.Ended /= Whole);
         pragma Loop_Invariant
           (Result.Start = Now and then Result.Finish = Now
            and then Result.Struck = Now
            and then Result.Error = Result.Error'Loop_Entry
            and then Result.Sent = Result.Sent'Loop_Entry
            and then Result.Heard = Result.Heard'Loop_Entry);
      end loop;
      B.Called (S) := False;
      if Result.Ended = Broken then
         Result.Position := 1;
         Result.Struck   := Now + B.Times.Nominal;
         Result.Finish := Result.Struck
           + Nanoseconds (Error_Frames.Length (Result.Error))
             * B.Times.Nominal;
         B.Free_At (S) :=
           Result.Finish + Intermission * B.Times.Nominal;
         Conclude
           (B, S, Roles,
            1 + Passive_Flag + After_Dominant, Noisy => False);
      end if;
   end Fail;

   -------------
   -- Contest --
   -------------

   procedure Contest
     (B      : in out Bus;
      S      : Segment;
      Now    : Start_Time;
      Offers : Offer_List;
      Fault  : Bus_Faults.Fault;
      Result : out Outcome)
   is
      Roles  : Role_List;
      Winner : Node_Index;
      Begun  : Boolean;
   begin
      Result :=
        (Start => Now, Finish => Now, Struck => Now, others => <>);
      case B.Line is
         when Sound          =>
            Arbitrate (B, S, Now, Offers, Roles, Winner, Begun);
            if Begun then
               Carry (B, S, Now, Offers, Fault, Roles, Winner, Result);
            elsif B.Called (S) then
               False_Start (B, S, Now, Roles);
            end if;
         when Held_Dominant  =>
            Hold (B, S, Now);
         when Held_Recessive =>
            Fail (B, S, Now, Offers, Result);
      end case;
   end Contest;

end Ravenchart.Can.Buses;
