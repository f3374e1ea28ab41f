--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The bus server without its sockets: it takes the records of the clients,
--  carries their requests out on the bus, and has the records for each client
--  with their times.
--
--  Guarantees   each request is answered once, by a confirmation or a refusal;
--               records for one client never go back in time. A client that
--               does not read is given up, and the server never waits for it
--  Tasking      none: one owner for each Server
--  Timing       Run: bounded by Steps frames

with Ravenchart.Can.Bus_Clients;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Bus_Queues;
with Ravenchart.Can.Bus_Records;
with Ravenchart.Can.Fault_Plans;
with Ravenchart.Can.Line_Events;
with Ravenchart.Can.Networks;

package Ravenchart.Can.Bus_Servers
  with SPARK_Mode
is
   use Bus_Nodes;
   use type Bus_Clients.Phase;

   Steps : constant := 1_000;
   --  Frames in one call of Run.

   type Client_List is array (Node_Index) of Bus_Clients.Client;

   Most_Events : constant := 64;

   subtype Event_Total is Natural range 0 .. Most_Events;

   subtype Event_Place is Positive range 1 .. Most_Events + 1;

   type Event_List is
     array (Event_Place range 1 .. Most_Events) of Line_Events.Event;

   type Agenda is record
      Events : Event_List;
      Count  : Event_Total := 0;
      Next   : Event_Place := 1;
   end record;
   --  Events in the order of their times; Next is the next event, or one
   --  beyond the last when there is none.

   type Journal is record
      Kept    : Boolean := False;
      Records : Bus_Queues.Queue;
   end record;
   --  The log of the bus, if it is kept: a record for each frame and each
   --  error frame. Run adds at most two for each frame.

   type Server is record
      Clients : Client_List;
      Net     : Networks.Network;
      Plan    : Fault_Plans.Plan;
      Agenda  : Bus_Servers.Agenda;
      Profile : Bus_Clients.Profile;
      Log     : Journal;
   end record;

   function Is_Room (Clients : Client_List) return Boolean
   is (for some C in Node_Index =>
         Clients (C).State = Bus_Clients.Unconnected)
   with Global => null;
   --  Can one more client connect?

   Hello_Limit : constant Nanoseconds := 2_000_000_000;
   --  The longest time from the connection to hello.

   procedure Connect
     (Clients : in out Client_List; Clock : Nanoseconds; C : out Node_Index)
   with
     Global => null,
     Pre    =>
       Is_Room (Clients) and then Clock <= Nanoseconds'Last - Hello_Limit,
     Post   => Clients (C).State = Bus_Clients.Greeting;
   --  A client has connected and has the number C. Clock is not bus time,
   --  which may stand still.

   procedure Expire (Clients : in out Client_List; Clock : Nanoseconds)
   with
     Global => null,
     Post   =>
       (for all C in Node_Index =>
          (if Clients (C).State = Bus_Clients.Greeting
           then Clock < Clients (C).Limit));
   --  End the connections of clients that have not sent hello in time.

   procedure Disconnect (S : in out Server; C : Node_Index)
   with
     Global => null,
     Post   => S.Clients (C).State = Bus_Clients.Unconnected;
   --  The connection of C has ended: it has left the bus.

   procedure Take
     (S     : in out Server;
      C     : Node_Index;
      Bytes : Bus_Records.Image;
      Now   : Nanoseconds)
   with Global => null;
   --  A record of C has come.

   function Is_Virtual (S : Server) return Boolean
   is (S.Profile.Began = 0)
   with Global => null;
   --  Does time advance only with events on the bus?

   function Latest (S : Server) return Nanoseconds
   is (if S.Net.Bus.Free_At (1) < S.Net.Bus.Free_At (2)
       then S.Net.Bus.Free_At (2) else S.Net.Bus.Free_At (1))
   with Global => null;
   --  The end of the last activity on the bus.

   procedure Run (S : in out Server; Horizon : Nanoseconds; Busy : out Boolean)
   with Global => null;
   --  Carry out everything that begins on the bus until Horizon; Busy when not
   --  all of it is done yet. The journal should be empty before.

   procedure Close_All (Clients : in out Client_List)
   with Global => null;
   --  The server ends: send all clients the status.

   function Next_Start (S : Server) return Nanoseconds
   with Global => null;
   --  The time of the next event on the bus; the last of all times if there is
   --  none.

end Ravenchart.Can.Bus_Servers;
