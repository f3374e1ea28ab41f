--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Arbitration;
with Ravenchart.Can.Levels;

package body Ravenchart.Can.Buses.Frame_Outcomes
  with SPARK_Mode
is
   use type Arbitration.Contender;
   use type Arbitration.Contender_Index;
   use type Bus_Faults.Fault_Kind;
   use type Bus_Frames.Bus_Frame_Family;
   use type Levels.Level;

   End_Bits : constant := 7;
   --  The bits of the end of frame.

   Intermission_Bits : constant := 3;

   Flag_Bits : constant := Error_Frames.Flag_Bits;
   --  The bits of an overload flag, as of an error flag.

   Overload_Bits : constant := Flag_Bits + 1 + Error_Frames.Delimiter_Bits;
   --  The bits of an overload frame: nodes that react to it begin one bit
   --  later.

   function Place_Of
     (F : Bus_Faults.Fault; I : Wire.Image) return Wire.Bit_Count
   is (if F.Kind = Bus_Faults.Disturbed_Bit
       then Bus_Frames.Least (F.Position, I.Ends (Wire.End_Of_Frame))
       elsif F.Position > End_Bits + Intermission_Bits
         or else I.Ends (Wire.Acknowledgement_Delimiter)
                 > Wire.Longest - F.Position
       then Wire.Length (I)
       else I.Ends (Wire.Acknowledgement_Delimiter) + F.Position)
   with Global => null;
   --  The disturbed bit of the frame, intermission included.

   function Has_Role
     (Roles : Role_List; Node : Bus_Faults.Victim; R : Role) return Boolean
   is (Node in 1 .. 16 and then Roles (Node_Index (Node)) = R)
   with Global => null;
   --  Has the node of a fault this role in the frame?

   function First_Difference (A, B : Wire.Image) return Wire.Bit_Index
   with Global => null;
   --  The first bit in which they differ; the last of all if none differs.

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

   ---------------
   -- Arbitrate --
   ---------------

   procedure Arbitrate
     (B      : Bus;
      S      : Segment;
      Now    : Nanoseconds;
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
   end Arbitrate;

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
      Found   : out Disturbance)
   is
      Last : constant Wire.Bit_Count := Image.Ends (Wire.End_Of_Frame);
      Slot : constant Wire.Bit_Count :=
        Image.Ends (Wire.Acknowledgement_Slot);
      Place : constant Wire.Bit_Count := Place_Of (Fault, Image);

      procedure Consider
        (Kind : Disturbance_Kind; Position : Wire.Bit_Count)
      with
        Global => (In_Out => Found),
        Pre    => Kind /= Undisturbed,
        Post   =>
          Found.Kind /= Undisturbed
          and then Found.Missed_By = Found.Missed_By'Old;
      --  Keep the earlier one of two disturbances.

      procedure Consider
        (Kind : Disturbance_Kind; Position : Wire.Bit_Count) is
      begin
         if Found.Kind = Undisturbed or else Position < Found.Position then
            Found.Kind     := Kind;
            Found.Position := Position;
         end if;
      end Consider;

      Answered : Boolean := False;
      Active   : Boolean := False;
      Hidden   : Boolean;
   begin
      Found := (others => <>);
      if Fault.Kind in Bus_Faults.Disturbed_Bit | Bus_Faults.Disturbed_End
        and then Place <= Last
      then
         if Fault.Node = Bus_Faults.Everyone
           or else Has_Role (Roles, Fault.Node, Sender)
         then
            Consider (Disturbed_Bit, Place);
         elsif Has_Role (Roles, Fault.Node, Listener) and then Place < Last
         then
            if Is_Passive (B.Nodes (Node_Index (Fault.Node))) then
               Found.Missed_By := Fault.Node;
            else
               Consider (Disturbed_Bit, Place);
            end if;
         end if;
      end if;

      for N in Node_Index loop
         if Roles (N) = Sender
           and then Offers (N).Frame /= Offers (Winner).Frame
         then
            Consider
              (Collision,
               Bus_Frames.Least
                 (First_Difference
                    (Image, Bus_Frames.Image_Of (Offers (N).Frame)),
                  Last));
         end if;
         pragma Loop_Invariant
           (if Found.Kind = Undisturbed
            then
              (for all M in 1 .. N =>
                 (if Roles (M) = Sender
                  then Offers (M).Frame = Offers (Winner).Frame)));
         pragma Loop_Invariant (Found.Missed_By = Found.Missed_By'Loop_Entry);
      end loop;

      for N in Node_Index loop
         Answered := Answered
           or else
             (Roles (N) = Listener
              and then
                (Natural (N) /= Found.Missed_By or else Place > Slot));
         Active := Active
           or else
             (Roles (N) /= Outside and then not Is_Passive (B.Nodes (N)));
      end loop;
      if not Answered
        or else Fault.Kind = Bus_Faults.Lost_Acknowledgement
      then
         Consider (Acknowledgement_Error, Slot);
      end if;

      Hidden := Has_Role (Roles, Fault.Node, Sender)
        and then Is_Passive (B.Nodes (Node_Index (Fault.Node)))
        and then Found.Position >= Image.Ends (Wire.Check_Field);
      case Found.Kind is
         when Undisturbed           =>
            null;
         when Disturbed_Bit         =>
            Found.Accepted := Hidden
              or else Found.Position >= Last
              or else
                (Found.Position = Last - 1
                 and then Fault.Node /= Bus_Faults.Everyone);
            Found.Recessive_Flag :=
              Hidden or else not (Active or Found.Accepted);
         when Collision             =>
            Found.Recessive_Flag := not Active;
         when Acknowledgement_Error =>
            Found.Recessive_Flag := Is_Passive (B.Nodes (Winner));
            Found.Accepted       := Found.Recessive_Flag;
      end case;
   end Find;

   --------------
   -- Error_Of --
   --------------

   function Error_Of
     (Roles : Role_List;
      Fault : Bus_Faults.Fault;
      Found : Disturbance;
      Image : Wire.Image) return Error_Frames.Error_Frame
   is (Kind =>
         (if Found.Kind = Acknowledgement_Error
          then Error_Frames.Acknowledgement_Error
          else Error_Frames.Bit_Error),
       Role => Error_Frames.Transmitter,
       Flag =>
         (if Found.Recessive_Flag
          then Error_Frames.Passive_Flag
          else Error_Frames.Active_Flag),
       Echo =>
         (case Found.Kind is
            when Undisturbed           => 0,
            when Disturbed_Bit         =>
              (if Fault.Node = Bus_Faults.Everyone
                 or else (Found.Accepted and then Found.Recessive_Flag)
               then 0
               elsif Found.Position >= Image.Ends (Wire.Acknowledgement_Slot)
               then 1
               else 6),
            when Collision             => 6,
            when Acknowledgement_Error =>
              (if Found.Recessive_Flag or else not Anyone (Roles, Listener)
               then 0 else 1)));

   ------------
   -- Behind --
   ------------

   function Behind
     (Roles : Role_List; Fault : Bus_Faults.Fault; Image : Wire.Image)
      return Aftermath
   is
      Alone : constant Boolean := Fault.Node /= Bus_Faults.Everyone;
      Place : constant Wire.Bit_Count := Place_Of (Fault, Image);
      First : constant Wire.Bit_Count := Image.Ends (Wire.End_Of_Frame);
      Pause : constant := Error_Frames.Delimiter_Bits + Intermission_Bits;
   begin
      if Alone
        and then not Has_Role (Roles, Fault.Node, Listener)
        and then not Has_Role (Roles, Fault.Node, Sender)
      then
         return (others => <>);
      end if;
      case Fault.Kind is
         when Bus_Faults.Overload =>
            declare
               Count : constant Overload_Count :=
                 (if Has_Role (Roles, Fault.Node, Sender) then 0
                  elsif Fault.Position >= 2 then 2
                  else 1);
            begin
               return
                 (Overload => Count,
                  Bits     => Count * Overload_Bits + Intermission_Bits,
                  others   => False);
            end;
         when Bus_Faults.Disturbed_Bit | Bus_Faults.Disturbed_End =>
            if Place = First then
               return
                 (Overload => 1,
                  Bits     => Overload_Bits + Intermission_Bits,
                  others   => False);
            elsif Place < First then
               return (others => <>);
            end if;
            case Wire.Bit_Count'(Place - First) is
               when 1      =>
                  return
                    (Overload => 1,
                     Bits     =>
                       1 + Flag_Bits + (if Alone then 1 else 0) + Pause,
                     others   => False);
               when 2      =>
                  return
                    (Overload    => 1,
                     Bits        =>
                       2 + Flag_Bits + (if Alone then Flag_Bits else 0)
                       + Pause,
                     Called      => False,
                     False_Start => Alone);
               when others =>
                  return
                    (Bits   => (if Alone then Intermission_Bits else 2),
                     Called => not Alone,
                     others => <>);
            end case;
         when others              =>
            return (others => <>);
      end case;
   end Behind;

   -----------------------
   -- Count_Stuff_Error --
   -----------------------

   procedure Count_Stuff_Error
     (Nodes : in out Node_List; Roles : Role_List; But : Natural) is
   begin
      for N in Node_Index loop
         if Roles (N) /= Outside
           and then Natural (N) /= But
           and then Takes_Part (Nodes (N))
         then
            Count (Nodes (N), Fault_Confinement.Receiver_Error);
         end if;
         pragma Loop_Invariant
           (for all M in Node_Index =>
              Is_Same_But_Counts (Nodes (M), Nodes'Loop_Entry (M))
              and then
                (if Roles (M) = Outside or else M > N
                 then Nodes (M) = Nodes'Loop_Entry (M)));
      end loop;
   end Count_Stuff_Error;

   -------------------
   -- Count_Outcome --
   -------------------

   procedure Count_Outcome
     (Nodes : in out Node_List;
      Roles : Role_List;
      Fault : Bus_Faults.Fault;
      Found : Disturbance;
      Sent  : out Node_Set;
      Heard : out Node_Set) is
   begin
      Sent  := (others => False);
      Heard := (others => False);
      for N in Node_Index loop
         if Roles (N) = Sender then
            Sent (N) := Found.Kind = Undisturbed;
            Count
              (Nodes (N),
               (case Found.Kind is
                  when Undisturbed               =>
                    Fault_Confinement.Transmitted,
                  when Disturbed_Bit | Collision =>
                    Fault_Confinement.Transmitter_Error,
                  when Acknowledgement_Error     =>
                    Fault_Confinement.Unanswered));
         elsif Roles (N) = Listener then
            if Natural (N) /= Found.Missed_By
              and then
                (Found.Kind = Undisturbed
                 or else
                   (Found.Accepted
                    and then
                      not Bus_Faults.Is_Witness (Fault, Positive (N))))
            then
               Heard (N) := True;
               Count (Nodes (N), Fault_Confinement.Received);
            else
               Count (Nodes (N), Fault_Confinement.Receiver_Error);
               if Found.Kind = Disturbed_Bit
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
                 and then Found.Kind = Undisturbed));
         pragma Loop_Invariant
           (for all M in Node_Index =>
              (if Heard (M) then Roles (M) = Listener)
              and then
                (if Found.Kind = Undisturbed
                   and then M <= N
                   and then Roles (M) = Listener
                   and then Natural (M) /= Found.Missed_By
                 then Heard (M)));
      end loop;
   end Count_Outcome;

end Ravenchart.Can.Buses.Frame_Outcomes;
