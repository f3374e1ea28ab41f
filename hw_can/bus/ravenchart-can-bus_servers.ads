--  The bus server without its sockets: what each client has said, what comes
--  of it on the bus, and what is to be said to whom, and when.
--
--  Guarantees   each request is answered once, by a confirmation or a
--               refusal; records for one client never go back in time; a
--               client that does not read is given up, and nobody waits
--  Tasking      none: one owner for each Server
--  Timing       Run: bounded by Steps frames

with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Bus_Records;
with Ravenchart.Can.Fault_Confinement;
with Ravenchart.Can.Fault_Plans;
with Ravenchart.Can.Line_Events;
with Ravenchart.Can.Networks;

package Ravenchart.Can.Bus_Servers
  with SPARK_Mode
is
   use Bus_Nodes;

   Most_Nodes : constant := 15;
   --  The last client of all is only told that there is no room.

   Steps : constant := 1_000;
   --  Frames in one call of Run.

   type Phase is (Unconnected, Greeting, Joined, Ending, Given_Up);
   --  Ending: to be closed when it has been told everything. Given_Up: to be
   --  closed at once, for it does not read.

   Depth : constant := 4_096;
   --  Records that may wait for one client.

   subtype Waiting_Count is Natural range 0 .. Depth;

   subtype Waiting_Index is Waiting_Count range 1 .. Depth;

   type Outgoing is record
      Bytes : Bus_Records.Image := (others => 0);
      Due   : Nanoseconds := 0;
   end record;
   --  A record, and the bus time from which it may be handed over.

   type Outgoing_List is array (Waiting_Index) of Outgoing;

   type Client is record
      State    : Phase := Unconnected;
      Takes_Fd : Boolean := False;
      Told     : Fault_Confinement.Node;
      Last     : Nanoseconds := 0;
      First    : Waiting_Index := 1;
      Count    : Waiting_Count := 0;
      Queue    : Outgoing_List;
   end record;
   --  Told: the counters that it knows. Last: the latest time that was said.
   --  The queue is a ring.

   type Client_List is array (Node_Index) of Client;

   subtype Event_Total is Natural range 0 .. 64;

   type Event_List is
     array (Event_Total range 1 .. 64) of Line_Events.Event;

   type Rates is record
      Nominal : Bus_Records.Bit_Rate range 1 .. 1_000_000 := 500_000;
      Data    : Bus_Records.Bit_Rate range 0 .. 20_000_000 := 2_000_000;
   end record;
   --  In bit/s; without a data rate the bus carries no FD frames.

   type Server is record
      Clients : Client_List;
      Net     : Networks.Network;
      Plan    : Fault_Plans.Plan;
      Events  : Event_List;
      Count   : Event_Total := 0;
      Next    : Event_Total := 1;
      Name    : String (1 .. 16) := (others => '-');
      Length  : Bus_Records.Name_Length := 1;
      Speed   : Rates;
      Began   : Nanoseconds := 0;
   end record;
   --  Events in the order of their times; Next is the first to come. Began:
   --  when bus time 0 was, in ns since 1970; 0 in virtual time.

   function Is_Sound (S : Server) return Boolean
   is (Networks.Is_Sound (S.Net)
       and then Bus_Records.Is_Name (S.Name (1 .. S.Length)))
   with Global => null;
   --  Is every buffer in order, and has the bus a name?

   function Is_Room (S : Server) return Boolean
   is (for some C in Node_Index => S.Clients (C).State = Unconnected);
   --  May one more connect?

   procedure Connect (S : in out Server; C : out Node_Index)
   with
     Global => null,
     Pre    => Is_Sound (S) and then Is_Room (S),
     Post   =>
       Is_Sound (S) and then S.Clients (C).State = Greeting;
   --  Somebody has connected, and is client C from now on.

   procedure Disconnect (S : in out Server; C : Node_Index)
   with
     Global => null,
     Pre    => Is_Sound (S),
     Post   =>
       Is_Sound (S) and then S.Clients (C).State = Unconnected;
   --  Its connection is gone: it has left the bus.

   procedure Take
     (S     : in out Server;
      C     : Node_Index;
      Bytes : Bus_Records.Image;
      Now   : Nanoseconds)
   with
     Global => null,
     Pre    => Is_Sound (S),
     Post   => Is_Sound (S);
   --  A record came from C.

   function Is_Virtual (S : Server) return Boolean
   is (S.Began = 0)
   with Global => null;
   --  Does time go on only when something happens on the bus?

   function Latest (S : Server) return Nanoseconds
   is (if S.Net.Bus.Free_At (1) < S.Net.Bus.Free_At (2)
       then S.Net.Bus.Free_At (2) else S.Net.Bus.Free_At (1))
   with Global => null;
   --  Until when the bus was busy last.

   procedure Run (S : in out Server; Horizon : Nanoseconds; Busy : out Boolean)
   with
     Global => null,
     Pre    => Is_Sound (S),
     Post   => Is_Sound (S);
   --  Everything that begins on the bus until then; Busy when that is not
   --  all yet.

   procedure Close_All (S : in out Server)
   with
     Global => null,
     Pre    => Is_Sound (S),
     Post   => Is_Sound (S);
   --  The server ends: everyone is told.

   function Has_Due
     (S : Server; C : Node_Index; Now : Nanoseconds) return Boolean
   is (S.Clients (C).Count > 0
       and then
         S.Clients (C).Queue (S.Clients (C).First).Due <= Now)
   with Global => null;
   --  Is there something to hand over to C?

   procedure Hand_Over
     (S : in out Server; C : Node_Index; Bytes : out Bus_Records.Image)
   with
     Global => null,
     Pre    => Is_Sound (S) and then S.Clients (C).Count > 0,
     Post   => Is_Sound (S);
   --  The next record for C.

   function Next_Due (S : Server; C : Node_Index) return Nanoseconds
   is (if S.Clients (C).Count > 0
       then S.Clients (C).Queue (S.Clients (C).First).Due
       else Nanoseconds'Last)
   with Global => null;
   --  When something is to be handed over to C; the last of all times if
   --  never.

   function Next_Start (S : Server) return Nanoseconds
   with Global => null;
   --  When something happens by itself; the last of all times if never.

end Ravenchart.Can.Bus_Servers;
