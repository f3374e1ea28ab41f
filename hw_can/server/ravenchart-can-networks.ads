--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Controllers with their transmit buffers on one simulated bus: their
--  requests, and the outcome of these.
--
--  Guarantees   a frame stays in its buffer until it was sent, also after lost
--               arbitration or an error; each node offers the head of its
--               buffer; time never goes back
--  Tasking      none: one owner for each Network
--  Timing       linear in the nodes and in the frames of a buffer

with Interfaces;
with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Buses;
with Ravenchart.Can.Fault_Confinement;
with Ravenchart.Can.Transmit_Buffers;

package Ravenchart.Can.Networks
  with SPARK_Mode, Pure
is
   pragma Assertion_Policy (Post => Ignore);
   --  A check would copy and compare all buffers for each frame.

   use Bus_Nodes;
   use type Bus_Frames.Bus_Frame;
   use type Buses.Bus;
   use type Buses.Line_State;
   use type Transmit_Buffers.Buffer;
   use type Buses.Offer_List;
   use type Buses.Offer;
   use type Interfaces.Unsigned_32;

   type Buffer_List is array (Node_Index) of Transmit_Buffers.Buffer;

   subtype Place_Of_Cut is Natural range 1 .. 17;

   Nowhere : constant Place_Of_Cut := 17;

   type Network is record
      Bus     : Buses.Bus;
      Buffers : Buffer_List;
      Babble  : Buses.Offer_List;
      Cut_At  : Place_Of_Cut := Nowhere;
   end record;
   --  The nodes from Cut_At upwards are cut off from those below. A node that
   --  babbles offers that frame in place of its own, again and again.

   function Waiting
     (N : Network; I : Node_Index) return Transmit_Buffers.Slot_Count
   is (Transmit_Buffers.Count (N.Buffers (I)))
   with Global => null;
   --  The number of frames that node I has still to send.

   function Head (N : Network; I : Node_Index) return Transmit_Buffers.Request
   is (Transmit_Buffers.Item (N.Buffers (I), 1))
   with Global => null, Pre => Waiting (N, I) > 0;
   --  The next offer of node I.

   function Offers (N : Network) return Buses.Offer_List
   with
     Global => null,
     Post   =>
       (for all I in Node_Index =>
          (if N.Babble (I).Present
           then Offers'Result (I).Present
             and then Offers'Result (I).Frame = N.Babble (I).Frame
           else
             Offers'Result (I).Present = (Waiting (N, I) > 0)
             and then
               (if Waiting (N, I) > 0
                then Offers'Result (I).Frame = Head (N, I).Frame)));
   --  The offers of all nodes.

   procedure Submit
     (N      : in out Network;
      I      : Node_Index;
      Item   : Transmit_Buffers.Request;
      Status : out Send_Status)
   with
     Global => null,
     Post   =>
       (Status = Queued)
         = (Waiting (N'Old, I) < Transmit_Buffers.Room)
       and then
         (if Status = Queued
          then Waiting (N, I) = Waiting (N'Old, I) + 1
          else N.Buffers (I) = N.Buffers'Old (I))
       and then
         (for all J in Node_Index =>
            (if J /= I then N.Buffers (J) = N.Buffers'Old (J)));
   --  Queue a frame, or reject it when the buffer is full.

   procedure Withdraw (N : in out Network; I : Node_Index)
   with
     Global => null,
     Post   =>
       Waiting (N, I) = 0
       and then N.Bus = N.Bus'Old;
   --  Remove all frames that node I has still to send.

   type Moment is record
      Known   : Boolean := False;
      Segment : Buses.Segment := 1;
      Start   : Nanoseconds := 0;
   end record;
   --  The time of the next event, if Known.

   function Next (N : Network) return Moment
   with
     Global => null,
     Post   =>
       (if Next'Result.Known
        then Next'Result.Start >= N.Bus.Free_At (Next'Result.Segment));
   --  The next event: a frame begins, a node comes back from bus-off, or a
   --  node counts on a bus that is held dominant.

   type Receipt is record
      Tag   : Interfaces.Unsigned_32 := 0;
      Since : Nanoseconds := 0;
   end record;
   --  A request that is done: the tag of its owner, and the time of the
   --  request.

   type Receipt_List is array (Node_Index) of Receipt;

   procedure Step
     (N        : in out Network;
      M        : Moment;
      Fault    : Bus_Faults.Fault;
      Result   : out Buses.Outcome;
      Receipts : out Receipt_List)
   with
     Global => null,
     Pre    =>
       M.Start in N.Bus.Free_At (M.Segment) .. Buses.Last_Start,
     Post   =>
       N.Babble = N.Babble'Old
       and then Result.Start = M.Start
       and then
         (for all S in Buses.Segment =>
            N.Bus.Free_At (S) >= N.Bus.Free_At'Old (S))
       and then
         (for all I in Node_Index =>
            (if Result.Sent (I) and then not N.Babble (I).Present
             then Waiting (N, I) = Waiting (N'Old, I) - 1
               and then Result.Frame = Head (N'Old, I).Frame
               and then Receipts (I).Tag = Head (N'Old, I).Tag
             else N.Buffers (I) = N.Buffers'Old (I)));
   --  Carry out the event at M. A request leaves its buffer when it was sent,
   --  and no other does.

   function Is_Held (N : Network; I : Node_Index) return Boolean
   is (N.Bus.Line = Buses.Held_Dominant
       and then Takes_Part (N.Bus.Nodes (I))
       and then
         Fault_Confinement.Receive_Errors (N.Bus.Nodes (I).Confinement)
         < Error_Count'Last)
   with Global => null;
   --  Does a dominant bus still increment a counter of node I?

end Ravenchart.Can.Networks;
