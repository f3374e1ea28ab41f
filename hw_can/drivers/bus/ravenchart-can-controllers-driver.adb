--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Driver "bus": a node of the simulated bus behind a bus server on this
--  machine (docs/bus-protocol.md), like each other process that joins it.
--
--  Guarantees   whatever a server sends or does, no exception is raised: the
--               connection ends, and the driver connects again. Frames go to
--               the server in the order sent, up to Most_Open ahead of its
--               answers
--  Tasking      a reader, which joins and receives the answers of the server,
--               and a writer, which waits for the transmit queue and for
--               requests of recovery
--  Timing       that of the server and of TCP: nothing here is real-time
--  Assumptions  ASM-005, the socket calls do what their specification states.
--               The server offers a node's oldest frame first, its default, or
--               the most urgent of up to Most_Open (buffers by priority)
--
--  RAVENCHART_BUS_PORT names the server, RAVENCHART_BUS_NAME this node; with _
--  and the name of a bus behind it, a variable is for that bus alone. Sent
--  counts the frames that were acknowledged on the bus, Rejected_Lines the
--  connections that a server made impossible. A node that is bus-off requests
--  recovery as its setting states, and its transmit queue waits until it is
--  back. Frames sent while there is no server are lost.

with Ada.Real_Time;
with Ravenchart.Epochs;
with Ravenchart.Can.Bus_Members;
with Ravenchart.Can.Bus_Records.Client_Side;
with Ravenchart.Can.Connections;
with Ravenchart.Can.Driver_Hosts;
with Ravenchart.Can.Ports;
with Ravenchart.Can.Sockets;
with Ravenchart.Can.Tcp_Sockets;

separate (Ravenchart.Can.Controllers)
package body Driver is
   pragma Refined_State
     ((State => (Line.State, Line.Wake_Up, Membership, Reader, Writer)));

   use type Queueing.Take_Status;
   use type Sockets.Socket;

   package Client_Side renames Bus_Records.Client_Side;

   subtype Wire_Record is Tcp_Sockets.Octets (Bus_Records.Position);
   --  A record in the form of the socket calls.

   package Line is new Connections (Ceiling => Transmit_Ceiling);
   --  The connection to the server.

   type Permission is (Write, Wait, Give_Up);
   --  The decision of the writer about a frame.

   protected Membership
     with Priority => Transmit_Ceiling
   is
      procedure Hear
        (A : Client_Side.Answer; Then_Do : out Bus_Members.Consequence);
      --  The answer A has come from the server.

      procedure Begin_Request
        (May    : out Permission;
         Number : out Bus_Members.Request_Number);
      --  May a frame be sent now, and under which number?

      procedure Begin_Recovery (Asked : Boolean; May : out Boolean);
      --  Is recovery to be requested from the server now? Asked: the program
      --  has requested it. There is one request for each bus-off.

      procedure Leave (Lost : out Bus_Members.Open_Count);
      --  The connection has ended: Lost requests were open.

      function Node return Bus_Members.Member;

   private
      Self    : Bus_Members.Member;
      Rescued : Boolean := False;
      --  True when recovery was requested from the server since bus-off.
   end Membership;

   Welcome_Limit : constant Tcp_Sockets.Patience := 2_000;
   --  The longest time until a server answers hello.

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Reader
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Joins the bus, and joins again after each end of the connection.

   task Writer
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Requests the transmission of the queued frames, and recovery.

   Bus_Port : constant Ports.Port :=
     Ports.Port (29_535 + Bus_Number);
   --  The default port of a bus server: 29_536 for the first bus of a node,
   --  29_537 for its second one, and so on.

   procedure Connect (Server : out Sockets.Socket; Port : out Ports.Port)
   with Global => (In_Out => (Driver_Hosts.Console, Sockets.Network));
   --  Become a client of the bus server on the port that RAVENCHART_BUS_PORT
   --  names, or Bus_Port.

   procedure Limit_Wait (Server : Sockets.Socket; To : Tcp_Sockets.Patience)
   with Global => (In_Out => (Driver_Hosts.Console, Sockets.Network));
   --  Limit the waits for the server to this time.

   procedure Say_Hello (Server : Sockets.Socket; Done : out Boolean)
   with Global => (In_Out => (Driver_Hosts.Console, Sockets.Network));
   --  Request to join, under the name that the environment gives.

   procedure Write (Bytes : Bus_Records.Image)
   with
     Global =>
       (In_Out => (Line.State, Line.Wake_Up, Sockets.Network));
   --  Send a record to the server. The answer, or the end of the connection,
   --  shows its result.

   procedure Recover
   with
     Global =>
       (In_Out => (Line.State, Line.Wake_Up, Membership, Upper.Wake_Up,
                   Sockets.Network));
   --  Request recovery from bus-off, if that is due.

   procedure Ask_To_Send (F : Any_Frames.Any_Frame; May : out Permission)
   with
     Global =>
       (In_Out => (Line.State, Line.Wake_Up, Membership, Upper.State,
                   Sockets.Network));
   --  Request the transmission of F, if a request is allowed.

   procedure Note_State
   with Global => (In_Out => Upper.State, Input => Membership);
   --  Note the state and the counters of the node.

   procedure Serve
     (Server    : Sockets.Socket;
      Port      : Ports.Port;
      Announced : in out Boolean)
   with
     Global =>
       (In_Out => (Membership, Upper.State, Upper.Wake_Up,
                   Driver_Hosts.Console, Sockets.Network),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  Send hello, then receive the answers of the server until the connection
   --  ends.

   protected body Membership is

      procedure Hear
        (A : Client_Side.Answer; Then_Do : out Bus_Members.Consequence) is
      begin
         Bus_Members.Hear (Self, A, Then_Do);
         Rescued := Rescued and then Bus_Members.State (Self) = Bus_Off;
      end Hear;

      procedure Begin_Request
        (May    : out Permission;
         Number : out Bus_Members.Request_Number) is
      begin
         Number := 1;
         if Bus_Members.State (Self) = Stopped then
            May := Give_Up;
         elsif Bus_Members.May_Ask (Self) then
            May := Write;
            Bus_Members.Ask (Self, Number);
         else
            May := Wait;
         end if;
      end Begin_Request;

      procedure Begin_Recovery (Asked : Boolean; May : out Boolean) is
      begin
         May :=
           Bus_Members.State (Self) = Bus_Off
           and then not Rescued
           and then (Asked or else Setting.Recovery = Automatic);
         Rescued := Rescued or else May;
      end Begin_Recovery;

      procedure Leave (Lost : out Bus_Members.Open_Count) is
      begin
         Bus_Members.Leave (Self, Lost);
         Rescued := False;
      end Leave;

      function Node return Bus_Members.Member
      is (Self);

   end Membership;

   -------------
   -- Connect --
   -------------

   procedure Connect (Server : out Sockets.Socket; Port : out Ports.Port) is
      Is_Sound : Boolean;
      Result   : Tcp_Sockets.Outcome;
   begin
      Server := Sockets.No_Socket;
      Ports.Read
        ("RAVENCHART_BUS_PORT",
         Bus_Name,
         Bus_Number,
         Bus_Port,
         Port,
         Is_Sound);
      if Is_Sound then
         Tcp_Sockets.Connect (Port, Server, Result);
         case Result is
            when Tcp_Sockets.Opened    =>
               null;
            when Tcp_Sockets.None_Left =>
               Driver_Hosts.Complain
                 (Bus_Number, "no socket: the system has none left");
            when Tcp_Sockets.Refused   =>
               Driver_Hosts.Complain
                 (Bus_Number,
                  "no bus server at 127.0.0.1:",
                  Natural (Port),
                  ": trying again");
         end case;
      end if;
   end Connect;

   ----------------
   -- Limit_Wait --
   ----------------

   procedure Limit_Wait (Server : Sockets.Socket; To : Tcp_Sockets.Patience)
   is
      Done : Boolean;
   begin
      Tcp_Sockets.Limit_Wait (Server, To, Done);
      if not Done then
         Driver_Hosts.Complain
           (Bus_Number, "this system has no limit for the wait on a socket");
      end if;
   end Limit_Wait;

   ---------------
   -- Say_Hello --
   ---------------

   procedure Say_Hello (Server : Sockets.Socket; Done : out Boolean) is
      Default : constant String := "ravenchart";
      Text    : String (1 .. 17);
      --  Room for a name, and for one character more.
      Last    : Natural;
      Bytes   : Bus_Records.Image;
   begin
      Driver_Hosts.Read_Setting
        ("RAVENCHART_BUS_NAME", Bus_Name, Text, Last);
      if Bus_Records.Is_Name (Text (1 .. Last)) then
         Bytes := Client_Side.Hello (Text (1 .. Last), Setting.Takes_Fd);
      else
         if Last > 0 then
            Driver_Hosts.Complain
              (Bus_Number,
               "RAVENCHART_BUS_NAME must have 1 to 16 characters from ! to ~;",
               " joining as ",
               Default);
         end if;
         Bytes := Client_Side.Hello (Default, Setting.Takes_Fd);
      end if;
      Tcp_Sockets.Send (Server, Wire_Record (Bytes), Done);
   end Say_Hello;

   -----------
   -- Write --
   -----------

   procedure Write (Bytes : Bus_Records.Image) is
      Server : Sockets.Socket;
      Done   : Boolean;
   begin
      Line.Begin_Use (Server);
      if Server /= Sockets.No_Socket then
         Tcp_Sockets.Send (Server, Wire_Record (Bytes), Done);
         if not Done then
            Tcp_Sockets.Break_Off (Server);
         end if;
      end if;
      Line.End_Use;
   end Write;

   -------------
   -- Recover --
   -------------

   procedure Recover is
      Asked : Boolean;
      May   : Boolean;
   begin
      Upper.Take_Request (Asked);
      Membership.Begin_Recovery (Asked, May);
      if May then
         Write (Client_Side.Recovery);
      end if;
   end Recover;

   -----------------
   -- Ask_To_Send --
   -----------------

   procedure Ask_To_Send (F : Any_Frames.Any_Frame; May : out Permission) is
      Number : Bus_Members.Request_Number;
   begin
      Membership.Begin_Request (May, Number);
      case May is
         when Write   =>
            Write (Client_Side.Request (F, Number));
         when Wait    =>
            null;
         when Give_Up =>
            Upper.Count (Upper.Lost_Out);
      end case;
   end Ask_To_Send;

   ----------------
   -- Note_State --
   ----------------

   procedure Note_State is
      Node : constant Bus_Members.Member := Membership.Node;
   begin
      Upper.Note_Errors
        (Transmit => Node.Transmit_Errors, Receive => Node.Receive_Errors);
      Upper.Note (Bus_Members.State (Node));
   end Note_State;

   -----------
   -- Serve --
   -----------

   procedure Serve
     (Server    : Sockets.Socket;
      Port      : Ports.Port;
      Announced : in out Boolean)
   is
      Bytes   : Wire_Record;
      Done    : Boolean;
      A       : Client_Side.Answer;
      Then_Do : Bus_Members.Consequence;
      Joined  : Boolean := False;
   begin
      Limit_Wait (Server, Welcome_Limit);
      Say_Hello (Server, Done);
      while Done loop
         Tcp_Sockets.Receive_All (Server, Bytes, Done);
         exit when not Done;
         A := Client_Side.Heard (Bus_Records.Image (Bytes));
         Membership.Hear (A, Then_Do);
         case Then_Do is
            when Bus_Members.Note_Joined    =>
               Joined := True;
               Note_State;
               Limit_Wait (Server, To => 0);
               if not Announced then
                  Driver_Hosts.Announce
                    ("joined the bus at 127.0.0.1:", Natural (Port));
                  Announced := True;
               end if;
            when Bus_Members.Take_Frame     =>
               Upper.Receive (A.Came);
            when Bus_Members.Note_State     =>
               Note_State;
               Upper.Wake;
            when Bus_Members.Count_Sent     =>
               Upper.Count (Upper.Sent);
               Upper.Wake;
            when Bus_Members.Count_Lost     =>
               Upper.Count (Upper.Lost_Out);
               Upper.Wake;
            when Bus_Members.Carry_On       =>
               null;
            when Bus_Members.End_Connection =>
               exit;
            when Bus_Members.Break_Off      =>
               Upper.Count (Upper.Rejected_Line);
               exit;
         end case;
      end loop;
      if not Joined then
         Driver_Hosts.Complain
           (Bus_Number,
            "the bus server does not take this node in: trying again");
      end if;
   end Serve;

   ------------
   -- Reader --
   ------------

   task body Reader is
      Server    : Sockets.Socket;
      Port      : Ports.Port;
      Announced : Boolean := False;
      Lost      : Bus_Members.Open_Count;
   begin
      delay until Epochs.Start;
      --  Wait for Start: a frame that came before the processors run would
      --  find no reader.
      loop
         Connect (Server, Port);
         if Server /= Sockets.No_Socket then
            Line.Attach (Server);
            Serve (Server, Port, Announced);
            --  The writer may be waiting for the server, or for an answer.
            Line.Detach;
            Membership.Leave (Lost);
            Upper.Count (Upper.Lost_Out, By => Event_Count (Lost));
            Note_State;
            Upper.Wake;
            Tcp_Sockets.Break_Off (Server);
            Line.Wait_Unused;
            Sockets.Close (Server);
         end if;
         Line.Pause (Milliseconds => 100);
      end loop;
   end Reader;

   ------------
   -- Writer --
   ------------

   task body Writer is
      F      : Any_Frames.Any_Frame := Any_Frames.Null_Any_Frame;
      Status : Queueing.Take_Status := Queueing.Empty;
      --  While Status is Taken, F has yet to be sent.
      May    : Permission;
   begin
      loop
         Recover;
         if Status = Queueing.Empty then
            Upper.Take_Queued (F, Status);
         end if;
         if Status = Queueing.Empty then
            Upper.Wait_Work;
         else
            Ask_To_Send (F, May);
            if May = Wait then
               Upper.Wait_Work;
            else
               Status := Queueing.Empty;
            end if;
         end if;
      end loop;
   end Writer;

end Driver;
