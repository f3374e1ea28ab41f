--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One controller on the simulated bus, without its buffers: its error
--  counters, and the time from which it may send.
--
--  Guarantees   a node that is bus-off takes no part; after its recovery was
--               requested, it returns as Fault_Confinement states
--  Tasking      none: nodes are values
--  Timing       Rest: at most 1408 steps

with Ravenchart.Can.Fault_Confinement;

package Ravenchart.Can.Bus_Nodes
  with SPARK_Mode, Pure
is
   use type Fault_Confinement.Fault_Event;

   type Node_Index is range 1 .. 16;
   --  Nodes on one bus.

   type Presence is (Absent, Present);
   --  An absent node has no controller on the bus.

   type Recovery is (Waits, Recovers);
   --  Was recovery requested for a node that is bus-off?

   subtype Restart_Delay is Nanoseconds range 0 .. 600_000_000_000;
   --  From bus-off to the automatic request for recovery; 0 for none.

   type Bus_Node is record
      Here        : Presence := Absent;
      Segment     : Node_Index := 1;
      Confinement : Fault_Confinement.Node;
      Way_Back    : Recovery := Waits;
      Ready_At    : Nanoseconds := 0;
      Restart     : Restart_Delay := 0;
   end record;
   --  The node sends nothing before Ready_At: an error-passive node waits for
   --  eight bits after its own frame (suspend transmission). While the node is
   --  bus-off, Ready_At is the time of the request for recovery: it counts no
   --  bit before.

   type Node_List is array (Node_Index) of Bus_Node;

   function Takes_Part (N : Bus_Node) return Boolean
   is (N.Here = Present
       and then Fault_Confinement.State (N.Confinement) /= Bus_Off)
   with Global => null;
   --  Does it send, listen and acknowledge?

   function Comes_Back (N : Bus_Node) return Boolean
   is (N.Here = Present
       and then N.Way_Back = Recovers
       and then Fault_Confinement.State (N.Confinement) = Bus_Off)
   with Global => null;
   --  Does it count recessive bits?

   function Is_Same_But_Counts (A, B : Bus_Node) return Boolean
   is (A.Here = B.Here
       and then A.Segment = B.Segment
       and then A.Ready_At = B.Ready_At
       and then A.Restart = B.Restart)
   with Global => null;
   --  Do they differ only in their counts?

   procedure Count
     (N : in out Bus_Node; Event : Fault_Confinement.Fault_Event)
   with
     Global => null,
     Pre    => Takes_Part (N),
     Post   =>
       Is_Same_But_Counts (N, N'Old)
       and then
         (if Event not in Fault_Confinement.Transmitter_Error
                        | Fault_Confinement.Unanswered
                        | Fault_Confinement.Transmitter_Flag_Error
                        | Fault_Confinement.Transmitter_Held_Dominant
          then Takes_Part (N));
   --  One event of fault confinement. A receiver never becomes bus-off. A node
   --  that does waits for a request for recovery.

   procedure Request_Recovery (N : in out Bus_Node; Start : Nanoseconds)
   with
     Global => null,
     Post   =>
       N.Here = N.Here'Old
       and then N.Segment = N.Segment'Old
       and then N.Restart = N.Restart'Old
       and then
         (if N.Here = Present
            and then Fault_Confinement.State (N.Confinement) = Bus_Off
          then Comes_Back (N) and then N.Ready_At <= Start
          else N = N'Old);
   --  The user requests recovery as of Start (ISO 11898-1 (2015), bus
   --  integration). A recovery that is already counting continues.

   function Quiet_Bits
     (N    : Bus_Node;
      Last : Nanoseconds;
      Most : Nanoseconds;
      Bit  : Positive_Nanoseconds) return Nanoseconds
   is (if N.Ready_At >= Last
       then 0
       else Nanoseconds'Min (Most, (Last - N.Ready_At) / Bit))
   with Global => null;
   --  The recessive bits after the request, of Most such bits up to Last.

   procedure Rest (N : in out Bus_Node; Bits : Nanoseconds)
   with
     Global => null,
     Post   => Is_Same_But_Counts (N, N'Old)
       and then (if not Comes_Back (N'Old) then N = N'Old);
   --  Count so many recessive bits in a row, during recovery.

   procedure Interrupt (N : in out Bus_Node)
   with
     Global => null,
     Post   => Is_Same_But_Counts (N, N'Old)
       and then (if not Comes_Back (N'Old) then N = N'Old);
   --  Count a dominant bit, during recovery.

end Ravenchart.Can.Bus_Nodes;
