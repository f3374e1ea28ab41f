with Ravenchart.Can.Arbitration;
with Ravenchart.Can.Levels;

package body Ravenchart.Can.Buses.Rulings
  with SPARK_Mode
is
   use type Arbitration.Contender;
   use type Arbitration.Contender_Index;
   use type Bus_Faults.Fault_Kind;
   use type Bus_Frames.Frame_Family;
   use type Levels.Level;

   function First_Difference (A, B : Wire.Image) return Wire.Bit_Index
   with Global => null;
   --  The first bit in which they differ; the last of all if none does.

   ----------------------
   -- First_Difference --
   ----------------------

   function First_Difference (A, B : Wire.Image) return Wire.Bit_Index is
   begin
      for P in Wire.Bit_Index loop
         if A.Bits (P) /= B.Bits (P) then
            return P;
         end if;
      end loop;
      return Wire.Longest;
   end First_Difference;

   ------------
   -- Settle --
   ------------

   procedure Settle
     (B      : Bus;
      S      : Segment;
      Now     : Nanoseconds;
      Offers : Offer_List;
      Roles  : out Role_List;
      Winner : out Node_Index;
      Begun  : out Boolean)
   is
      subtype Place is Arbitration.Contender_Index range 1 .. 16;
      subtype Place_Count is Natural range 0 .. 16;
      type Node_Map is array (Place) of Node_Index;
      type Place_Map is array (Node_Index) of Place;
      Contest : Arbitration.Contender_List (Place) := (others => <>);
      Who     : Node_Map := (others => 1);
      Where   : Place_Map := (others => 1);
      Count   : Place_Count := 0;
   begin
      Winner := 1;
      Begun  := False;
      Roles  := (others => Outside);
      for N in Node_Index loop
         if Listens (B, N, S) then
            Roles (N) := Listener;
         end if;
         pragma Loop_Invariant
           (for all M in Node_Index =>
              Roles (M) =
                (if M <= N and then Listens (B, M, S)
                 then Listener else Outside));
      end loop;

      for N in Node_Index loop
         if Contends (B, N, S, Now, Offers)
           and then Offers (N).Frame.Family = Bus_Frames.Asked_Error
         then
            Winner    := N;
            Begun     := True;
            Roles (N) := Sender;
            return;
         end if;
         pragma Loop_Invariant
           (for all M in 1 .. N =>
              (if Contends (B, M, S, Now, Offers)
               then
                 Offers (M).Frame.Family /= Bus_Frames.Asked_Error));
      end loop;

      for N in Node_Index loop
         if Contends (B, N, S, Now, Offers) then
            Count := Count + 1;
            Contest (Place (Count)) :=
              Bus_Frames.Contender_Of (Offers (N).Frame);
            Who (Place (Count)) := N;
            Where (N) := Place (Count);
         end if;
         pragma Loop_Invariant (Count <= Natural (N));
         pragma Loop_Invariant
           (for all P in Place =>
              (if Natural (P) <= Count
               then Contends (B, Who (P), S, Now, Offers)
                 and then Contest (P) =
                   Bus_Frames.Contender_Of (Offers (Who (P)).Frame)));
         pragma Loop_Invariant
           (for all M in 1 .. N =>
              (if Contends (B, M, S, Now, Offers)
               then Natural (Where (M)) <= Count
                 and then Who (Where (M)) = M));
      end loop;

      if Count = 0 then
         return;
      end if;
      declare
         Last    : constant Place := Place (Count);
         First   : Arbitration.Contender_Index;
         Lost_In : Arbitration.Loss_List (1 .. Last);
         Ignored : Arbitration.Bus_Levels;
      begin
         Arbitration.Arbitrate
           (Contest (1 .. Last), First, Lost_In, Ignored);
         Winner := Who (First);
         Begun  := True;
         for P in Lost_In'Range loop
            if Lost_In (P) = 0 then
               Roles (Who (P)) := Sender;
            end if;
            pragma Loop_Invariant (Fits (Roles, B, S));
            pragma Loop_Invariant
              (for all N in Node_Index =>
                 (if Roles (N) = Sender
                  then Contends (B, N, S, Now, Offers)));
            pragma Loop_Invariant
              (if P >= First then Roles (Winner) = Sender);
         end loop;
      end;
   end Settle;

   ----------
   -- Find --
   ----------

   procedure Find
     (B       : Bus;
      Offers  : Offer_List;
      Roles   : Role_List;
      Winner  : Node_Index;
      Fault   : Bus_Faults.Fault;
      Image   : Wire.Image;
      Found   : out Trouble)
   is
      Last : constant Wire.Bit_Count := Image.Ends (Wire.End_Of_Frame);
      Slot : constant Wire.Bit_Count :=
        Image.Ends (Wire.Acknowledgement_Slot);

      procedure Consider (Kind : Trouble_Kind; Position : Wire.Bit_Count)
      with
        Global => (In_Out => Found),
        Pre    => Kind /= Untroubled,
        Post   =>
          Found.Kind /= Untroubled and then Found.Deaf = Found.Deaf'Old;
      --  The earlier trouble is the one that happens.

      procedure Consider (Kind : Trouble_Kind; Position : Wire.Bit_Count) is
      begin
         if Found.Kind = Untroubled or else Position < Found.Position then
            Found.Kind     := Kind;
            Found.Position := Position;
         end if;
      end Consider;

      Answered : Boolean := False;
   begin
      Found := (others => <>);
      if Fault.Kind = Bus_Faults.Disturbed_Bit then
         if Fault.Node = Bus_Faults.Everyone then
            Consider (Seen, Bus_Frames.Least (Fault.Position, Last));
         elsif Fault.Node <= 16 then
            if Roles (Node_Index (Fault.Node)) = Listener
              and then Is_Passive (B.Nodes (Node_Index (Fault.Node)))
            then
               Found.Deaf := Fault.Node;
            elsif Roles (Node_Index (Fault.Node)) /= Outside then
               Consider (Seen, Bus_Frames.Least (Fault.Position, Last));
            end if;
         end if;
      end if;

      for N in Node_Index loop
         if Roles (N) = Sender
           and then Offers (N).Frame /= Offers (Winner).Frame
         then
            Consider
              (Collided,
               Bus_Frames.Least
                 (First_Difference
                    (Image, Bus_Frames.Image_Of (Offers (N).Frame)),
                  Last));
         end if;
         pragma Loop_Invariant
           (if Found.Kind = Untroubled
            then
              (for all M in 1 .. N =>
                 (if Roles (M) = Sender
                  then Offers (M).Frame = Offers (Winner).Frame)));
         pragma Loop_Invariant (Found.Deaf = Found.Deaf'Loop_Entry);
      end loop;

      for N in Node_Index loop
         Answered := Answered
           or else
             (Roles (N) = Listener
              and then
                (Natural (N) /= Found.Deaf or else Fault.Position > Slot));
      end loop;
      if not Answered
        or else Fault.Kind = Bus_Faults.Lost_Acknowledgement
      then
         Consider (Unacknowledged, Slot);
      end if;
   end Find;

   -----------
   -- Judge --
   -----------

   procedure Judge
     (Nodes : in out Node_List;
      Roles : Role_List;
      Fault : Bus_Faults.Fault;
      Found : Trouble;
      Quiet : Boolean;
      Sent  : out Node_Set;
      Heard : out Node_Set) is
   begin
      Sent  := (others => False);
      Heard := (others => False);
      for N in Node_Index loop
         if Roles (N) = Sender then
            Sent (N) := Found.Kind = Untroubled;
            Count
              (Nodes (N),
               (case Found.Kind is
                  when Untroubled      => Fault_Confinement.Transmitted,
                  when Seen | Collided =>
                    Fault_Confinement.Transmitter_Error,
                  when Unacknowledged  => Fault_Confinement.Unanswered));
         elsif Roles (N) = Listener then
            if Natural (N) /= Found.Deaf
              and then
                (Found.Kind = Untroubled
                 or else (Found.Kind = Unacknowledged and then Quiet))
            then
               Heard (N) := True;
               Count (Nodes (N), Fault_Confinement.Received);
            else
               Count (Nodes (N), Fault_Confinement.Receiver_Error);
               if Found.Kind = Seen
                 and then Bus_Faults.Is_Witness (Fault, Positive (N))
               then
                  Count
                    (Nodes (N),
                     Fault_Confinement.Dominant_After_Receiver_Flag);
               end if;
            end if;
         end if;
         pragma Loop_Invariant
           (for all M in Node_Index =>
              Is_Same_But_Counts (Nodes (M), Nodes'Loop_Entry (M))
              and then
                (if Roles (M) = Outside or else M > N
                 then Nodes (M) = Nodes'Loop_Entry (M)));
         pragma Loop_Invariant
           (for all M in Node_Index =>
              Sent (M) =
                (M <= N
                 and then Roles (M) = Sender
                 and then Found.Kind = Untroubled));
         pragma Loop_Invariant
           (for all M in Node_Index =>
              (if Heard (M) then Roles (M) = Listener)
              and then
                (if Found.Kind = Untroubled
                   and then M <= N
                   and then Roles (M) = Listener
                   and then Natural (M) /= Found.Deaf
                 then Heard (M)));
      end loop;
   end Judge;

end Ravenchart.Can.Buses.Rulings;
