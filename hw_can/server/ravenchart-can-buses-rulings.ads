--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The rulings on one frame: who sends it, what happens to it first, and
--  what that does to everyone's error counters.
--
--  Guarantees   the winner is first in arbitration; without trouble all
--               senders send the same frame, and all receivers but one that
--               is deaf hear it
--  Tasking      none: rulings are values
--  Timing       linear in the length of a frame and in the nodes

with Ravenchart.Can.Fault_Confinement;

private package Ravenchart.Can.Buses.Rulings
  with SPARK_Mode, Pure
is

   type Role is (Outside, Listener, Sender);
   --  What a node is in one frame, once arbitration is over.

   type Role_List is array (Node_Index) of Role;

   type Trouble_Kind is (Untroubled, Seen, Collided, Unacknowledged);
   --  Seen: a bit was disturbed, for everyone or for one witness. Collided:
   --  two frames were alike in arbitration, and differ behind it.

   type Trouble is record
      Kind     : Trouble_Kind := Untroubled;
      Position : Wire.Bit_Count := 0;
      Deaf     : Natural range 0 .. 16 := 0;
      Accepted : Boolean := False;
      Silent   : Boolean := False;
   end record;
   --  Deaf: an error-passive receiver that alone saw a disturbed bit, so
   --  that its flag disturbs nobody. Accepted: receivers that are no witness
   --  take the frame, for they saw no error before its last bit but one.
   --  Silent: the error flag on the bus is recessive.

   type Aftermath is record
      Overload : Overload_Count := 0;
      Bits     : Wire.Bit_Count := 3;
      Called   : Boolean := False;
      Misled   : Boolean := False;
   end record;
   --  What follows the last bit of a frame. Bits: until another may begin.
   --  Called: the bit behind them is read as a start of frame. Misled: all
   --  but the witness take an overload flag for a start of frame.

   function Is_Passive (N : Bus_Node) return Boolean
   is (Fault_Confinement.State (N.Confinement) /= Error_Active)
   with Global => null;
   --  Is its error flag a passive one?

   function Fits
     (Roles : Role_List; B : Bus; S : Segment) return Boolean
   is (for all N in Node_Index =>
         (Roles (N) /= Outside) = Listens (B, N, S))
   with
     Ghost,
     Global => null;
   --  Has everyone who listens a role, and nobody else?

   function Anyone (Roles : Role_List; R : Role) return Boolean
   is (for some N in Node_Index => Roles (N) = R)
   with Global => null;
   --  Has somebody this role?

   procedure Settle
     (B      : Bus;
      S      : Segment;
      Now     : Nanoseconds;
      Offers : Offer_List;
      Roles  : out Role_List;
      Winner : out Node_Index;
      Begun  : out Boolean)
   with
     Global => null,
     Post   =>
       Fits (Roles, B, S)
       and then
         (for all N in Node_Index =>
            (if Roles (N) = Sender then Contends (B, N, S, Now, Offers)))
       and then
         (if Begun
          then Roles (Winner) = Sender
            and then
              (for all N in Node_Index =>
                 (if Contends (B, N, S, Now, Offers)
                  then
                    Bus_Frames.Is_First
                      (Offers (Winner).Frame, Offers (N).Frame))));
   --  Arbitration. Frames that are alike in it are all still sent.

   procedure Find
     (B       : Bus;
      Offers  : Offer_List;
      Roles   : Role_List;
      Winner  : Node_Index;
      Fault   : Bus_Faults.Fault;
      Image   : Wire.Image;
      Found   : out Trouble)
   with
     Global => null,
     Pre    => Roles (Winner) = Sender,
     Post   =>
       (if Found.Kind = Untroubled
        then
          (for all N in Node_Index =>
             (if Roles (N) = Sender
              then Offers (N).Frame = Offers (Winner).Frame)))
       and then
         (if Found.Deaf > 0
          then Bus_Faults.Is_Witness (Fault, Found.Deaf));
   --  What happens first to the frame that is on the bus.

   function Error_Of
     (Roles : Role_List;
      Fault : Bus_Faults.Fault;
      Found : Trouble;
      Image : Wire.Image) return Error_Frames.Error_Frame
   with Global => null, Pre => Found.Kind /= Untroubled;
   --  The error frame that is on the bus then.

   function Behind
     (Roles : Role_List; Fault : Bus_Faults.Fault; Image : Wire.Image)
      return Aftermath
   with
     Global => null,
     Post   => Behind'Result.Bits <= 40;
   --  What follows a frame that came to its end (ISO 11898-1 (2015), overload
   --  frame and intermission).

   procedure Mislead
     (Nodes : in out Node_List; Roles : Role_List; But : Natural)
   with
     Global => null,
     Post   =>
       (for all N in Node_Index =>
          Is_Same_But_Counts (Nodes (N), Nodes'Old (N))
          and then
            (if Roles (N) = Outside then Nodes (N) = Nodes'Old (N)));
   --  A start of frame without a frame: a stuff error for everyone But one.

   procedure Judge
     (Nodes : in out Node_List;
      Roles : Role_List;
      Fault : Bus_Faults.Fault;
      Found : Trouble;
      Sent  : out Node_Set;
      Heard : out Node_Set)
   with
     Global => null,
     Pre    =>
       (for all N in Node_Index =>
          (if Roles (N) /= Outside then Takes_Part (Nodes (N)))),
     Post   =>
       (for all N in Node_Index =>
          Is_Same_But_Counts (Nodes (N), Nodes'Old (N))
          and then
            (if Roles (N) = Outside then Nodes (N) = Nodes'Old (N)))
       and then
         (for all N in Node_Index =>
            Sent (N) =
              (Roles (N) = Sender and then Found.Kind = Untroubled))
       and then
         (for all N in Node_Index =>
            (if Heard (N) then Roles (N) = Listener)
            and then
              (if Found.Kind = Untroubled
                 and then Roles (N) = Listener
                 and then Natural (N) /= Found.Deaf
               then Heard (N)));
   --  Everyone's error counters.

end Ravenchart.Can.Buses.Rulings;
