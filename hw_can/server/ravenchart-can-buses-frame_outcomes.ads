--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The outcome of one frame: its senders, its first disturbance, and its
--  effect on the error counters of all nodes.
--
--  Guarantees   the winner is first in arbitration; without a disturbance all
--               senders send the same frame, and all receivers receive it,
--               except one that alone read a disturbed bit
--  Tasking      none: outcomes are values
--  Timing       linear in the length of a frame and in the nodes

with Ravenchart.Can.Fault_Confinement;

private package Ravenchart.Can.Buses.Frame_Outcomes
  with SPARK_Mode, Pure
is

   type Role is (Outside, Listener, Sender);
   --  The role of a node in one frame after arbitration.

   type Role_List is array (Node_Index) of Role;

   type Disturbance_Kind is
     (Undisturbed, Disturbed_Bit, Collision, Acknowledgement_Error);
   --  Disturbed_Bit: all nodes or one witness read a bit with the opposite
   --  level. Collision: two frames were alike in arbitration, and differ after
   --  it, which is a bit error. Acknowledgement_Error: the transmitter read
   --  the acknowledgement slot recessive.

   type Disturbance is record
      Kind           : Disturbance_Kind := Undisturbed;
      Position       : Wire.Bit_Count := 0;
      Missed_By      : Natural range 0 .. 16 := 0;
      Accepted       : Boolean := False;
      Recessive_Flag : Boolean := False;
   end record;
   --  Missed_By: an error-passive receiver that alone read a disturbed bit.
   --  It misses the frame, and its passive error flag disturbs no other node.
   --  Accepted: receivers except the witness accept the frame, since they read
   --  no error before its last bit but one. Recessive_Flag: the error flag on
   --  the bus is recessive.

   type Aftermath is record
      Overload    : Overload_Count := 0;
      Bits        : Wire.Bit_Count := 3;
      Called      : Boolean := False;
      False_Start : Boolean := False;
   end record;
   --  The bits after the last bit of a frame. Overload: the overload frames.
   --  Bits: their number, until the next frame can begin. Called: the bit
   --  after them is read as a start of frame. False_Start: all nodes except
   --  the witness read an overload flag as a start of frame.

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
   --  Do exactly the nodes that listen have a role?

   function Anyone (Roles : Role_List; R : Role) return Boolean
   is (for some N in Node_Index => Roles (N) = R)
   with Global => null;
   --  Has any node this role?

   procedure Arbitrate
     (B      : Bus;
      S      : Segment;
      Now    : Nanoseconds;
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
   --  Carry out the arbitration. Frames that are alike in it are all sent on.

   procedure Find
     (B       : Bus;
      Offers  : Offer_List;
      Roles   : Role_List;
      Winner  : Node_Index;
      Fault   : Bus_Faults.Fault;
      Image   : Wire.Image;
      Found   : out Disturbance)
   with
     Global => null,
     Pre    => Roles (Winner) = Sender,
     Post   =>
       (if Found.Kind = Undisturbed
        then
          (for all N in Node_Index =>
             (if Roles (N) = Sender
              then Offers (N).Frame = Offers (Winner).Frame)))
       and then
         (if Found.Missed_By > 0
          then Bus_Faults.Is_Witness (Fault, Found.Missed_By));
   --  Find the first disturbance of the frame that is on the bus.

   function Error_Of
     (Roles : Role_List;
      Fault : Bus_Faults.Fault;
      Found : Disturbance;
      Image : Wire.Image) return Error_Frames.Error_Frame
   with Global => null, Pre => Found.Kind /= Undisturbed;
   --  The error frame of this disturbance.

   function Behind
     (Roles : Role_List; Fault : Bus_Faults.Fault; Image : Wire.Image)
      return Aftermath
   with
     Global => null,
     Post   => Behind'Result.Bits <= 40;
   --  The bits after a frame that was completed (ISO 11898-1 (2015), overload
   --  frame and intermission).

   procedure Count_Stuff_Error
     (Nodes : in out Node_List; Roles : Role_List; But : Natural)
   with
     Global => null,
     Post   =>
       (for all N in Node_Index =>
          Is_Same_But_Counts (Nodes (N), Nodes'Old (N))
          and then
            (if Roles (N) = Outside then Nodes (N) = Nodes'Old (N)));
   --  Count the stuff error after a start of frame without a frame, at all
   --  nodes But one.

   procedure Count_Outcome
     (Nodes : in out Node_List;
      Roles : Role_List;
      Fault : Bus_Faults.Fault;
      Found : Disturbance;
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
              (Roles (N) = Sender and then Found.Kind = Undisturbed))
       and then
         (for all N in Node_Index =>
            (if Heard (N) then Roles (N) = Listener)
            and then
              (if Found.Kind = Undisturbed
                 and then Roles (N) = Listener
                 and then Natural (N) /= Found.Missed_By
               then Heard (N)));
   --  Count the outcome of the frame in the error counters of all nodes.

end Ravenchart.Can.Buses.Frame_Outcomes;
