--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One client of the bus server: its progress in the protocol, and the records
--  for it.
--
--  Guarantees   the latest time in its records never goes back; a client that
--               does not read is given up
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
   use type Bus_Frames.Bus_Frame_Family;
   use type Bus_Records.Request_Kind;
   use type Error_Frames.Error_Kind;
   use type Interfaces.Unsigned_32;

   Most_Nodes : constant := 15;
   --  The last client of all only receives the status that there is no room.

   type Phase is (Unconnected, Greeting, Joined, Ending, Given_Up);
   --  Ending: to be closed when it has received all records. Given_Up: to be
   --  closed at once, for it does not read.

   type Client is record
      State    : Phase := Unconnected;
      Takes_Fd : Boolean := False;
      Told     : Fault_Confinement.Node;
      Last     : Nanoseconds := 0;
      Limit    : Nanoseconds := 0;
      Queue    : Bus_Queues.Queue;
   end record;
   --  Told: the counters in its last bus state. Last: the latest time in its
   --  records. Limit: the time by which it must have sent hello, by the clock
   --  of the server.

   type Profile is record
      Name    : Bus_Names.Bus_Name;
      Nominal : Bus_Records.Bit_Rate range 1 .. 1_000_000 := 500_000;
      Data    : Bus_Records.Bit_Rate range 0 .. 20_000_000 := 2_000_000;
      Began   : Nanoseconds := 0;
      Restart : Restart_Delay := 0;
   end record;
   --  The properties of a bus. Rates are in bit/s; without a data rate the bus
   --  carries no FD frames. Began: the time of bus time 0 in ns since 1970; 0
   --  in virtual time. Restart: the restart delay of nodes that request none
   --  of their own.

   function Suits (R : Bus_Records.Request; P : Profile) return Boolean
   is ((R.Nominal = 0 or else R.Nominal = P.Nominal)
       and then (R.Data = 0 or else R.Data = P.Data))
   with Global => null;
   --  Does this bus have the rates of a hello?

   function Knows
     (To : Client; Node : Fault_Confinement.Node) return Boolean
   is (Fault_Confinement.Transmit_Errors (To.Told)
       = Fault_Confinement.Transmit_Errors (Node)
       and then
         Fault_Confinement.Receive_Errors (To.Told)
         = Fault_Confinement.Receive_Errors (Node))
   with Global => null;
   --  Does the client know the present counters of its node?

   function Time_Heard
     (To     : Client;
      C      : Node_Index;
      Result : Buses.Outcome;
      Fault  : Bus_Faults.Fault) return Nanoseconds
   with Global => null, Post => Time_Heard'Result >= To.Last;
   --  The time of the record of Result for client C: the end of Result, or
   --  later by the fault, and not before its last record.

   function Restart_For
     (R : Bus_Records.Request; P : Profile) return Restart_Delay
   is (if R.Number = 0
       then P.Restart
       else Nanoseconds (R.Number) * 1_000_000)
   with
     Global => null,
     Pre    => R.Number <= Bus_Records.Longest_Restart;
   --  The restart delay of the node of a hello.

   procedure Welcome (To : in out Client; Limit : Nanoseconds)
   with Global => null, Post => To.State = Greeting;
   --  The client has connected, and has to send hello by Limit.

   procedure Forget (To : in out Client)
   with Global => null, Post => To.State = Unconnected;
   --  The connection of the client has ended.

   procedure End_With (To : in out Client; Why : Bus_Records.Status)
   with
     Global => null,
     Post   =>
       To.State in Ending | Given_Up and then To.Last = To.Last'Old;
   --  Send the status Why, and close.

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
   --  Handle the first record of client C. Joins: it gets a controller, whose
   --  counters are 0.

   procedure Refuse
     (To     : in out Client;
      Number : Interfaces.Unsigned_32;
      Why    : Bus_Records.Status)
   with
     Global => null,
     Post   =>
       To.State in To.State'Old | Given_Up and then To.Last = To.Last'Old;
   --  Refuse this request.

   procedure Refuse_All
     (To : in out Client; B : Transmit_Buffers.Buffer)
   with Global => null, Post => To.Last = To.Last'Old;
   --  Refuse all requests in B, for the node is bus-off.

   procedure Tell_Frame
     (To     : in out Client;
      C      : Node_Index;
      Result : Buses.Outcome;
      Tag    : Interfaces.Unsigned_32;
      Fault  : Bus_Faults.Fault)
   with Global => null, Post => To.Last >= To.Last'Old;
   --  Send the record of a frame to client C, if the frame was sent or
   --  received there. Tag: the request that is done; 0 when it was none.

   function Report
     (Kind : Error_Frames.Error_Kind; Now : Nanoseconds)
      return Bus_Records.Image
   is (if Kind = Error_Frames.Acknowledgement_Error
       then Bus_Records.Error_Report (16#20#, 0, Now)
       else Bus_Records.Error_Report (16#08#, 16#1_0000#, Now))
   with Global => null;
   --  An error frame, as in Linux's can/error.h: no acknowledgement, or a bit
   --  error.

   procedure Tell_Error
     (To : in out Client; Kind : Error_Frames.Error_Kind)
   with Global => null, Post => To.Last = To.Last'Old;
   --  Send the record of an error frame.

   procedure Tell_State
     (To : in out Client; Node : Fault_Confinement.Node)
   with
     Global => null,
     Post   =>
       To.State in To.State'Old | Given_Up and then To.Last = To.Last'Old;
   --  Send the present counters.

   function Has_Due (To : Client; Now : Nanoseconds) return Boolean
   is (To.Queue.Count > 0
       and then Bus_Queues.Item (To.Queue, 1).Due <= Now)
   with Global => null;
   --  Is a record due?

   procedure Hand_Over
     (To : in out Client; Bytes : out Bus_Records.Image)
   with Global => null, Pre => To.Queue.Count > 0;
   --  Take the next record.

   function Next_Due (To : Client) return Nanoseconds
   is (if To.Queue.Count > 0
       then Bus_Queues.Item (To.Queue, 1).Due
       else Nanoseconds'Last)
   with Global => null;
   --  The time at which the next record is due; the last of all times if there
   --  is none.

end Ravenchart.Can.Bus_Clients;
