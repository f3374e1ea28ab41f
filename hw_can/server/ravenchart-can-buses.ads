--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A bus in virtual time: its nodes, the outcome of the frames that are
--  offered at one instant, and their effect on all error counters.
--
--  Guarantees   time never goes back. The frame that is received and sent is
--               that of the winner, and no other offer precedes it. A frame
--               that is sent was offered; no node receives its own frame
--  Tasking      none: one owner for each Bus
--  Timing       linear in the length of a frame and in the nodes
--
--  ISO 11898-1 (2015): arbitration, acknowledgement, error signalling and
--  fault confinement; bits are synchronous at all nodes. A cut divides the bus
--  into segments, each with its own time. Simpler than the standard: an error
--  flag or overload flag is not sent again when it is disturbed.

with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Error_Frames;
with Ravenchart.Can.Wire;

package Ravenchart.Can.Buses
  with SPARK_Mode, Pure
is
   use Bus_Nodes;
   use type Bus_Frames.Bit_Times;
   use type Bus_Frames.Bus_Frame;

   type Line_State is (Sound, Held_Dominant, Held_Recessive);
   --  Held: shorted, so that no node can drive the other level.

   subtype Segment is Node_Index;
   --  A connected part of the bus; at first all nodes are in segment 1.

   Last_Start : constant Nanoseconds :=
     Nanoseconds'Last - 4 * Bus_Frames.Longest_Time;
   --  The last instant at which a frame can begin.

   subtype Start_Time is Nanoseconds range 0 .. Last_Start;

   type Free_Times is array (Segment) of Nanoseconds;

   type Segment_Set is array (Segment) of Boolean;

   type Bus is record
      Times   : Bus_Frames.Bit_Times;
      Line    : Line_State := Sound;
      Free_At : Free_Times := (others => 0);
      Called  : Segment_Set := (others => False);
      Nodes   : Node_List;
   end record;
   --  A segment is busy, intermission included, until Free_At. Called: at
   --  Free_At, the third bit of the intermission, all nodes read a dominant
   --  bit, which is a start of frame.

   type Offer is record
      Frame   : Bus_Frames.Bus_Frame;
      Present : Boolean := False;
   end record;
   --  The head of a controller's transmit buffer, if there is one.

   type Offer_List is array (Node_Index) of Offer;

   type Node_Set is array (Node_Index) of Boolean;

   function Listens
     (B : Bus; N : Node_Index; S : Segment) return Boolean
   is (Takes_Part (B.Nodes (N)) and then B.Nodes (N).Segment = S)
   with Global => null;
   --  Is N on this segment, and not bus-off?

   function Contends
     (B      : Bus;
      N      : Node_Index;
      S      : Segment;
      Now    : Nanoseconds;
      Offers : Offer_List) return Boolean
   is (Listens (B, N, S)
       and then Offers (N).Present
       and then B.Nodes (N).Ready_At <= Now)
   with Global => null;
   --  Does N start to send there at that time?

   type Ending is (Silence, Whole, Broken);
   --  Silence: no node sent. Whole: the frame was completed. Broken: the frame
   --  ended in an error frame.

   subtype Overload_Count is Natural range 0 .. 2;
   --  At most two overload frames delay the next frame.

   type Outcome is record
      Ended    : Ending := Silence;
      Start    : Nanoseconds := 0;
      Finish   : Nanoseconds := 0;
      Winner   : Node_Index := 1;
      Frame    : Bus_Frames.Bus_Frame;
      Sent     : Node_Set := (others => False);
      Heard    : Node_Set := (others => False);
      Position : Wire.Bit_Count := 0;
      Struck   : Nanoseconds := 0;
      Error    : Error_Frames.Error_Frame;
      Overload : Overload_Count := 0;
   end record;
   --  Finish is the end of the frame, before the intermission. Sent: the nodes
   --  whose offer is done. Heard: the nodes that have received Frame.
   --  Position, Struck and Error, when Broken: the bit after which the error
   --  frame begins, the time, and the error frame. Overload: the overload
   --  frames after a Whole frame. For a receiver a frame is valid one bit
   --  earlier than for its transmitter: so a frame that ended in an error
   --  frame may have been received.

   function Is_Same_Beyond
     (B, Before : Bus; S : Segment) return Boolean
   is (B.Times = Before.Times
       and then B.Line = Before.Line
       and then
         (for all T in Segment =>
            (if T /= S then B.Free_At (T) = Before.Free_At (T)))
       and then
         (for all N in Node_Index =>
            (if Before.Nodes (N).Segment /= S
             then B.Nodes (N) = Before.Nodes (N))))
   with Ghost, Global => null;
   --  Is the bus unchanged, except for segment S and the nodes on it?

   function Is_In_Time
     (Result : Outcome; Now, Free_At : Nanoseconds) return Boolean
   is (Result.Start = Now
       and then Result.Finish in Now .. Free_At
       and then Result.Struck <= Free_At)
   with Ghost, Global => null;
   --  Do the instants of Result lie between Now and the time from which the
   --  segment is free?

   procedure Pass (B : in out Bus; S : Segment; Now : Nanoseconds)
   with
     Global => null,
     Pre    => B.Free_At (S) <= Now,
     Post   =>
       B.Times = B.Times'Old
       and then B.Line = B.Line'Old
       and then
         (for all T in Segment =>
            B.Free_At (T) = (if T = S then Now else B.Free_At'Old (T)))
       and then
         (for all N in Node_Index =>
            (if B.Nodes'Old (N).Segment = S
             then Is_Same_But_Counts (B.Nodes (N), B.Nodes'Old (N))
             else B.Nodes (N) = B.Nodes'Old (N)))
       and then
         (for all N in Node_Index =>
            (if not Comes_Back (B.Nodes'Old (N))
             then B.Nodes (N) = B.Nodes'Old (N)));
   --  The segment was idle up to Now: bus-off nodes in recovery have counted
   --  its recessive bits.

   procedure Recover (B : in out Bus; N : Node_Index; Now : Nanoseconds)
   with
     Global => null,
     Post   =>
       B.Times = B.Times'Old
       and then B.Line = B.Line'Old
       and then B.Free_At = B.Free_At'Old
       and then
         (for all M in Node_Index =>
            (if M /= N then B.Nodes (M) = B.Nodes'Old (M)));
   --  The user of node N requests recovery from bus-off. The node counts the
   --  recessive bits after Now: those of an idle bus before do not count,
   --  those at the end of a frame that is being sent do.

   procedure Contest
     (B      : in out Bus;
      S      : Segment;
      Now    : Start_Time;
      Offers : Offer_List;
      Fault  : Bus_Faults.Fault;
      Result : out Outcome)
   with
     Global => null,
     Pre    => B.Free_At (S) = Now,
     Post   =>
       Is_Same_Beyond (B, B'Old, S)
       and then Is_In_Time (Result, Now, B.Free_At (S))
       and then
         (for all N in Node_Index =>
            (if Result.Sent (N)
             then Contends (B'Old, N, S, Now, Offers)
               and then Offers (N).Frame = Result.Frame
               and then not Result.Heard (N)))
       and then
         (for all N in Node_Index =>
            (if Result.Heard (N) then Listens (B'Old, N, S)))
       and then
         (if Result.Ended /= Silence
          then Contends (B'Old, Result.Winner, S, Now, Offers)
            and then Offers (Result.Winner).Frame = Result.Frame)
       and then
         (if Result.Ended = Whole
          then Result.Sent (Result.Winner)
            and then
              (for all N in Node_Index =>
                 (if Listens (B'Old, N, S)
                    and then not Result.Sent (N)
                    and then
                      not Bus_Faults.Is_Witness (Fault, Positive (N))
                  then Result.Heard (N))))
       and then
         (if B.Line = Sound and then Result.Ended /= Silence
          then
            (for all N in Node_Index =>
               (if Contends (B'Old, N, S, Now, Offers)
                then Bus_Frames.Is_First (Result.Frame, Offers (N).Frame))));
   --  All nodes on segment S that have a frame to send start at that time.

end Ravenchart.Can.Buses;
