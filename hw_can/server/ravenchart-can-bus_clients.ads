--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One client of the bus server: how far it has come, and what it is told.
--
--  Guarantees   the latest time that it was told never goes back; a client
--               that does not read is given up
--  Tasking      none: one owner for each Client
--  Timing       linear in the requests that are refused

with Interfaces;
with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Bus_Names;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Bus_Queues;
with Ravenchart.Can.Bus_Records;
with Ravenchart.Can.Buses;
with Ravenchart.Can.Error_Frames;
with Ravenchart.Can.Fault_Confinement;
with Ravenchart.Can.Transmit_Buffers;

package Ravenchart.Can.Bus_Clients
  with SPARK_Mode, Pure
is
   use Bus_Nodes;
   use type Bus_Frames.Frame_Family;
   use type Bus_Records.Request_Kind;
   use type Error_Frames.Error_Kind;
   use type Interfaces.Unsigned_32;

   Most_Nodes : constant := 15;
   --  The last client of all is only told that there is no room.

   type Phase is (Unconnected, Greeting, Joined, Ending, Given_Up);
   --  Ending: to be closed when it has been told everything. Given_Up: to be
   --  closed at once, for it does not read.

   type Client is record
      State    : Phase := Unconnected;
      Takes_Fd : Boolean := False;
      Told     : Fault_Confinement.Node;
      Last     : Nanoseconds := 0;
      Limit    : Nanoseconds := 0;
      Queue    : Bus_Queues.Queue;
   end record;
   --  Told: the counters that it knows. Last: the latest time that was said.
   --  Limit: by when it must have said hello, by the clock of the server.

   type Profile is record
      Name    : Bus_Names.Bus_Name;
      Nominal : Bus_Records.Bit_Rate range 1 .. 1_000_000 := 500_000;
      Data    : Bus_Records.Bit_Rate range 0 .. 20_000_000 := 2_000_000;
      Began   : Nanoseconds := 0;
      Restart : Restart_Delay := 0;
   end record;
   --  What a bus says of itself. Rates in bit/s; without a data rate it
   --  carries no FD frames. Began: when bus time 0 was, in ns since 1970; 0
   --  in virtual time. Restart: of the nodes that want none of their own.

   function Suits (R : Bus_Records.Request; P : Profile) return Boolean
   is ((R.Nominal = 0 or else R.Nominal = P.Nominal)
       and then (R.Data = 0 or else R.Data = P.Data))
   with Global => null;
   --  Does this bus have the rates that a hello wants?

   function Knows
     (To : Client; Node : Fault_Confinement.Node) return Boolean
   is (Fault_Confinement.Transmit_Errors (To.Told)
       = Fault_Confinement.Transmit_Errors (Node)
       and then
         Fault_Confinement.Receive_Errors (To.Told)
         = Fault_Confinement.Receive_Errors (Node))
   with Global => null;
   --  Does the client know the counters of its node as they are?

   function Time_Heard
     (To     : Client;
      C      : Node_Index;
      Result : Buses.Outcome;
      Fault  : Bus_Faults.Fault) return Nanoseconds
   with Global => null, Post => Time_Heard'Result >= To.Last;
   --  When client C is told of what happened: at its end, or as late as the
   --  fault makes it, and not before what it was told last.

   function Restart_For
     (R : Bus_Records.Request; P : Profile) return Restart_Delay
   is (if R.Number = 0
       then P.Restart
       else Nanoseconds (R.Number) * 1_000_000)
   with
     Global => null,
     Pre    => R.Number <= Bus_Records.Longest_Restart;
   --  The restart delay of a node that said this hello.

   procedure Welcome (To : in out Client; Limit : Nanoseconds)
   with Global => null, Post => To.State = Greeting;
   --  It has connected, and has to say hello until then.

   procedure Forget (To : in out Client)
   with Global => null, Post => To.State = Unconnected;
   --  Its connection is gone.

   procedure End_With (To : in out Client; Why : Bus_Records.Status)
   with
     Global => null,
     Post   =>
       To.State in Ending | Given_Up and then To.Last = To.Last'Old;
   --  Say why, and close.

   procedure Greet
     (To    : in out Client;
      C     : Node_Index;
      P     : Profile;
      R     : Bus_Records.Request;
      Now   : Nanoseconds;
      Joins : out Boolean)
   with
     Global => null,
     Post   =>
       Joins
       = (C <= Most_Nodes
          and then R.Kind = Bus_Records.Hello
          and then Suits (R, P))
       and then
         (if Joins
          then To.State in Joined | Given_Up and then To.Last = Now
          else To.State in Ending | Given_Up);
   --  The first thing that client C has said. Joins: it gets a controller,
   --  whose counters are 0.

   procedure Refuse
     (To     : in out Client;
      Number : Interfaces.Unsigned_32;
      Why    : Bus_Records.Status)
   with
     Global => null,
     Post   =>
       To.State in To.State'Old | Given_Up and then To.Last = To.Last'Old;
   --  This request is not done.

   procedure Refuse_All
     (To : in out Client; B : Transmit_Buffers.Buffer)
   with Global => null, Post => To.Last = To.Last'Old;
   --  None of what is there is done, for the node is bus-off.

   procedure Tell_Frame
     (To     : in out Client;
      C      : Node_Index;
      Result : Buses.Outcome;
      Tag    : Interfaces.Unsigned_32;
      Fault  : Bus_Faults.Fault)
   with Global => null, Post => To.Last >= To.Last'Old;
   --  Client C is told of a frame, if it was sent or heard there. Tag: of the
   --  request that is done; 0 when it was none.

   function Report
     (Kind : Error_Frames.Error_Kind; Now : Nanoseconds)
      return Bus_Records.Image
   is (if Kind = Error_Frames.Acknowledgement_Error
       then Bus_Records.Error_Report (16#20#, 0, Now)
       else Bus_Records.Error_Report (16#08#, 16#1_0000#, Now))
   with Global => null;
   --  An error frame, as in Linux's can/error.h: nobody acknowledged, or a
   --  bit error.

   procedure Tell_Error
     (To : in out Client; Kind : Error_Frames.Error_Kind)
   with Global => null, Post => To.Last = To.Last'Old;
   --  An error frame was seen.

   procedure Tell_State
     (To : in out Client; Node : Fault_Confinement.Node)
   with
     Global => null,
     Post   =>
       To.State in To.State'Old | Given_Up and then To.Last = To.Last'Old;
   --  These are its counters now.

   function Has_Due (To : Client; Now : Nanoseconds) return Boolean
   is (To.Queue.Count > 0
       and then Bus_Queues.Item (To.Queue, 1).Due <= Now)
   with Global => null;
   --  Is there something to hand over?

   procedure Hand_Over
     (To : in out Client; Bytes : out Bus_Records.Image)
   with Global => null, Pre => To.Queue.Count > 0;
   --  The next record.

   function Next_Due (To : Client) return Nanoseconds
   is (if To.Queue.Count > 0
       then Bus_Queues.Item (To.Queue, 1).Due
       else Nanoseconds'Last)
   with Global => null;
   --  When something is to be handed over; the last of all times if never.

end Ravenchart.Can.Bus_Clients;
