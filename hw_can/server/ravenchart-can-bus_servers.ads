--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The bus server without its sockets: what each client has said, what comes
--  of it on the bus, and what is to be said to whom, and when.
--
--  Guarantees   each request is answered once, by a confirmation or a
--               refusal; records for one client never go back in time; a
--               client that does not read is given up, and nobody waits
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
   --  Events in the order of their times; Next is the first to come, behind
   --  the last one when none is.

   type Journal is record
      Kept    : Boolean := False;
      Records : Bus_Queues.Queue;
   end record;
   --  What was on the bus, if it is kept: a record for each frame and each
   --  error frame. Run makes at most two a frame.

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
   --  May one more connect?

   Hello_Limit : constant Nanoseconds := 2_000_000_000;
   --  From the connection to hello.

   procedure Connect
     (Clients : in out Client_List; Clock : Nanoseconds; C : out Node_Index)
   with
     Global => null,
     Pre    =>
       Is_Room (Clients) and then Clock <= Nanoseconds'Last - Hello_Limit,
     Post   => Clients (C).State = Bus_Clients.Greeting;
   --  Somebody has connected, and is client C from now on. The Clock is not
   --  that of the bus, whose time may stand still.

   procedure Expire (Clients : in out Client_List; Clock : Nanoseconds)
   with
     Global => null,
     Post   =>
       (for all C in Node_Index =>
          (if Clients (C).State = Bus_Clients.Greeting
           then Clock < Clients (C).Limit));
   --  The connection of a client that has not said hello in time ends.

   procedure Disconnect (S : in out Server; C : Node_Index)
   with
     Global => null,
     Post   => S.Clients (C).State = Bus_Clients.Unconnected;
   --  Its connection is gone: it has left the bus.

   procedure Take
     (S     : in out Server;
      C     : Node_Index;
      Bytes : Bus_Records.Image;
      Now   : Nanoseconds)
   with Global => null;
   --  A record came from C.

   function Is_Virtual (S : Server) return Boolean
   is (S.Profile.Began = 0)
   with Global => null;
   --  Does time go on only when something happens on the bus?

   function Latest (S : Server) return Nanoseconds
   is (if S.Net.Bus.Free_At (1) < S.Net.Bus.Free_At (2)
       then S.Net.Bus.Free_At (2) else S.Net.Bus.Free_At (1))
   with Global => null;
   --  Until when the bus was busy last.

   procedure Run (S : in out Server; Horizon : Nanoseconds; Busy : out Boolean)
   with Global => null;
   --  Everything that begins on the bus until then; Busy when that is not
   --  all yet. The journal should be empty before.

   procedure Close_All (Clients : in out Client_List)
   with Global => null;
   --  The server ends: everyone is told.

   function Next_Start (S : Server) return Nanoseconds
   with Global => null;
   --  When something happens by itself; the last of all times if never.

end Ravenchart.Can.Bus_Servers;
