--  Driver "bus": a node of the simulated bus behind a bus server on this
--  machine (docs/bus-protocol.md), as each other process that joins it.
--
--  Guarantees   whatever a server says or does, nothing is raised: the
--               connection ends, and another is tried; frames go to the
--               server in the order sent, Most_Open ahead of its answers
--  Tasking      a reader, which joins and takes what the server says, and a
--               writer, which waits for the transmit queue and for requests
--               of recovery
--  Timing       that of the server and of TCP: nothing here is real-time
--  Assumptions  ASM-005, the socket calls do what their spec says; the
--               server offers a node's oldest frame first, its default, or
--               the most urgent of up to Most_Open (buffers by priority)
--
--  RAVENCHART_BUS_PORT and RAVENCHART_BUS_NAME say which server, and who
--  joins. Sent counts what the bus has acknowledged, Rejected_Lines the
--  connections that a server made impossible. A node that is bus-off asks for
--  recovery as its setting says, and its transmit queue waits meanwhile; while
--  there is no server, what is sent is lost.

with Ada.Real_Time;
with Ada.Synchronous_Task_Control;
with Ravenchart.Epochs;
with Ravenchart.Queues;
with Ravenchart.Can.Bus_Members;
with Ravenchart.Can.Bus_Records.Client_Side;
with Ravenchart.Can.Received_Frames;
with Ravenchart.Can.Tcp_Sockets;

package body Ravenchart.Can.Controllers
  with
    SPARK_Mode,
    Refined_State =>
      (State   => (Transmit.State, Receive.State, Link, Reader, Writer),
       Wake_Up => (Receive.Wake_Up, Let_Go, Work, Recovery_Asked))
is
   pragma Warnings
     (GNATprove, Off, "no Always_Terminates aspect available*",
      Reason => "ASM-008, the library does not say it of suspension objects");
   pragma Warnings
     (GNATprove, Off, "assuming * always terminates",
      Reason => "ASM-008, the library does not say it of suspension objects");

   use Ada.Synchronous_Task_Control;
   use type Ada.Real_Time.Time;
   use type Bus_Members.Consequence;
   use type Queueing.Put_Status;
   use type Queueing.Take_Status;
   use type Tcp_Sockets.Socket;

   package Client_Side renames Bus_Records.Client_Side;

   subtype Wire_Record is Tcp_Sockets.Octets (Bus_Records.Position);
   --  A record as the socket calls take it.

   package Transmit is new Queues
     (Element_Type => Any_Frames.Any_Frame,
      Null_Element => Any_Frames.Null_Any_Frame,
      Capacity     => Transmit_Depth,
      Ceiling      => Transmit_Ceiling,
      Policy       => Queueing.Reject_Newest);

   package Receive is new Received_Frames
     (Capacity => Receive_Depth, Ceiling => Receive_Ceiling);

   type Permission is (Write, Wait, Give_Up);
   --  What the writer does with a frame.

   protected Link
     with Priority => Transmit_Ceiling
   is
      procedure Attach (To : Tcp_Sockets.Socket);
      --  There is a connection; the server has still to take us in.

      procedure Detach;
      --  The connection is gone: no further record is begun.

      procedure Hear
        (A : Client_Side.Answer; Then_Do : out Bus_Members.Consequence);
      --  The server has said A.

      procedure Begin_Request
        (May    : out Permission;
         Number : out Bus_Members.Request_Number;
         To     : out Tcp_Sockets.Socket);
      --  May a frame be sent now, under which number, and where to?

      procedure Begin_Recovery
        (Asked : Boolean;
         May   : out Boolean;
         To    : out Tcp_Sockets.Socket);
      --  Is the server to be asked for recovery now, and where? Asked:
      --  recovery was requested. Of one bus-off it is asked once.

      procedure End_Request;
      --  The record was written, or not: the answer, or the end of the
      --  connection, tells.

      procedure Count_Received;
      --  A frame was accepted.

      function Is_Idle return Boolean;
      --  The writer uses no socket.

      function Faults return Fault_Notices.Fault_Log;

      function All_Counts return Counters;

   private
      Server  : Tcp_Sockets.Socket := Tcp_Sockets.No_Socket;
      Idle    : Boolean := True;
      --  False while the writer uses the server's socket.
      Node    : Bus_Members.Member;
      Log     : Fault_Notices.Fault_Log;
      Rescued : Boolean := False;
      --  True when the server was asked for recovery since bus-off.
   end Link;

   Welcome_Limit : constant Tcp_Sockets.Patience := 2_000;
   --  So long a server may take to answer hello.

   Let_Go : Suspension_Object;
   --  True when the writer may have become idle since the reader looked.

   Work : Suspension_Object;
   --  True when the writer may have more to do, or be allowed more, since it
   --  looked.

   Recovery_Asked : Boolean := False
   with Atomic;
   --  True when recovery was requested since the writer looked.

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Reader
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Joins the bus, as often as it must.

   task Writer
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Asks for what is in the transmit queue to be sent, and for recovery.

   procedure Say_Hello (Server : Tcp_Sockets.Socket; Done : out Boolean)
   with Global => (In_Out => Tcp_Sockets.Network);
   --  Ask to be taken in, under the name that the environment gives.

   procedure Take (F : Any_Frames.Any_Frame)
   with
     Global =>
       (In_Out => (Link, Receive.State, Receive.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  A frame came over the bus.

   procedure Recover
   with
     Global =>
       (In_Out => (Link, Let_Go, Recovery_Asked, Tcp_Sockets.Network));
   --  Ask for the way out of bus-off, if that is due.

   procedure Ask_To_Send (F : Any_Frames.Any_Frame; May : out Permission)
   with Global => (In_Out => (Link, Let_Go, Tcp_Sockets.Network));
   --  Ask the server to send F, if that is allowed.

   procedure Serve (Server : Tcp_Sockets.Socket; Announced : in out Boolean)
   with
     Global =>
       (In_Out => (Link, Receive.State, Receive.Wake_Up, Work,
                   Tcp_Sockets.Network),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  Say hello, and take what the server says until the connection ends.

   procedure Wait_Idle
   with Global => (In_Out => Let_Go, Input => Link);
   --  Suspend the reader until the writer uses no socket.

   procedure Pause (Milliseconds : Positive)
   with Global => (Input => Ada.Real_Time.Clock_Time);
   --  Let time pass before the next connection.

   protected body Link is

      procedure Attach (To : Tcp_Sockets.Socket) is
      begin
         Server := To;
      end Attach;

      procedure Detach is
      begin
         Server := Tcp_Sockets.No_Socket;
         Bus_Members.Leave (Node);
         Log     := Fault_Notices.Noted (Log, Stopped);
         Rescued := False;
      end Detach;

      procedure Hear
        (A : Client_Side.Answer; Then_Do : out Bus_Members.Consequence) is
      begin
         Bus_Members.Hear (Node, A, Then_Do);
         Log     := Fault_Notices.Noted (Log, Bus_Members.State (Node));
         Rescued := Rescued and then Log.State = Bus_Off;
      end Hear;

      procedure Begin_Request
        (May    : out Permission;
         Number : out Bus_Members.Request_Number;
         To     : out Tcp_Sockets.Socket) is
      begin
         Number := 1;
         To     := Server;
         if Bus_Members.State (Node) = Stopped then
            May := Give_Up;
            Bus_Members.Count_Lost (Node);
         elsif Bus_Members.May_Ask (Node) then
            May  := Write;
            Idle := False;
            Bus_Members.Ask (Node, Number);
         else
            May := Wait;
         end if;
      end Begin_Request;

      procedure Begin_Recovery
        (Asked : Boolean;
         May   : out Boolean;
         To    : out Tcp_Sockets.Socket) is
      begin
         To  := Server;
         May :=
           Log.State = Bus_Off
           and then not Rescued
           and then (Asked or else Setting.Recovery = Automatic);
         if May then
            Rescued := True;
            Idle    := False;
         end if;
      end Begin_Recovery;

      procedure End_Request is
      begin
         Idle := True;
      end End_Request;

      procedure Count_Received is
      begin
         Bus_Members.Count_Received (Node);
      end Count_Received;

      function Is_Idle return Boolean
      is (Idle);

      function Faults return Fault_Notices.Fault_Log
      is (Log);

      function All_Counts return Counters
      is (Node.Counts);

   end Link;

   ---------------
   -- Say_Hello --
   ---------------

   procedure Say_Hello (Server : Tcp_Sockets.Socket; Done : out Boolean) is
      Default : constant String := "ravenchart";
      Text    : Tcp_Sockets.Name_Text;
      Last    : Tcp_Sockets.Name_Length;
      Bytes   : Bus_Records.Image;
   begin
      Tcp_Sockets.Read_Name (Text, Last);
      if Bus_Records.Is_Name (Text (1 .. Last)) then
         Bytes := Client_Side.Hello (Text (1 .. Last), Setting.Takes_Fd);
      else
         if Last > 0 then
            Tcp_Sockets.Complain
              ("RAVENCHART_BUS_NAME must have 1 to 16 characters from ! to ~;"
               & " joining as " & Default);
         end if;
         Bytes := Client_Side.Hello (Default, Setting.Takes_Fd);
      end if;
      Tcp_Sockets.Send (Server, Wire_Record (Bytes), Done);
   end Say_Hello;

   ----------
   -- Take --
   ----------

   procedure Take (F : Any_Frames.Any_Frame) is
   begin
      if Any_Frames.Fits (F, Setting)
        and then Accepts (Any_Frames.Id (F), Any_Frames.Format (F))
      then
         Link.Count_Received;
         Receive.Put (F);
      end if;
   end Take;

   -------------
   -- Recover --
   -------------

   procedure Recover is
      Asked  : constant Boolean := Recovery_Asked;
      May    : Boolean;
      Server : Tcp_Sockets.Socket;
      Done   : Boolean;
   begin
      if Asked then
         Recovery_Asked := False;
      end if;
      Link.Begin_Recovery (Asked, May, Server);
      if May then
         Tcp_Sockets.Send (Server, Wire_Record (Client_Side.Recovery), Done);
         if not Done then
            Tcp_Sockets.Break_Off (Server);
         end if;
         Link.End_Request;
         Set_True (Let_Go);
      end if;
   end Recover;

   -----------------
   -- Ask_To_Send --
   -----------------

   procedure Ask_To_Send (F : Any_Frames.Any_Frame; May : out Permission) is
      Number : Bus_Members.Request_Number;
      Server : Tcp_Sockets.Socket;
      Done   : Boolean;
   begin
      Link.Begin_Request (May, Number, Server);
      if May = Write then
         Tcp_Sockets.Send
           (Server, Wire_Record (Client_Side.Request (F, Number)), Done);
         if not Done then
            Tcp_Sockets.Break_Off (Server);
         end if;
         Link.End_Request;
         Set_True (Let_Go);
      end if;
   end Ask_To_Send;

   -----------
   -- Serve --
   -----------

   procedure Serve (Server : Tcp_Sockets.Socket; Announced : in out Boolean)
   is
      Bytes   : Wire_Record;
      Done    : Boolean;
      A       : Client_Side.Answer;
      Then_Do : Bus_Members.Consequence;
      Joined  : Boolean := False;
   begin
      Tcp_Sockets.Limit_Wait (Server, Welcome_Limit);
      Say_Hello (Server, Done);
      while Done loop
         Tcp_Sockets.Receive_All (Server, Bytes, Done);
         exit when not Done;
         A := Client_Side.Heard (Bus_Records.Image (Bytes));
         Link.Hear (A, Then_Do);
         case Then_Do is
            when Bus_Members.Note_Joined    =>
               Joined := True;
               Tcp_Sockets.Limit_Wait (Server, To => 0);
               if not Announced then
                  Tcp_Sockets.Announce_Joined;
                  Announced := True;
               end if;
            when Bus_Members.Take_Frame     =>
               Take (A.Came);
            when Bus_Members.Ask_Recovery | Bus_Members.Carry_On =>
               Set_True (Work);
            when Bus_Members.End_Connection =>
               exit;
         end case;
      end loop;
      if not Joined then
         Tcp_Sockets.Complain
           ("the bus server does not take this node in: trying again");
      end if;
   end Serve;

   ---------------
   -- Wait_Idle --
   ---------------

   procedure Wait_Idle is
      Idle : Boolean;
   begin
      loop
         Idle := Link.Is_Idle;
         exit when Idle;
         Suspend_Until_True (Let_Go);
      end loop;
   end Wait_Idle;

   -----------
   -- Pause --
   -----------

   procedure Pause (Milliseconds : Positive) is
      Now : constant Ada.Real_Time.Time := Ada.Real_Time.Clock;
   begin
      delay until Now + Ada.Real_Time.Milliseconds (Milliseconds);
   end Pause;

   ------------
   -- Reader --
   ------------

   task body Reader is
      Server    : Tcp_Sockets.Socket;
      Announced : Boolean := False;
   begin
      delay until Epochs.Start;
      --  Frames that come before the processors run would find nobody.
      loop
         Tcp_Sockets.Connect (Server);
         if Server /= Tcp_Sockets.No_Socket then
            Link.Attach (Server);
            Serve (Server, Announced);
            --  The writer may be waiting for the server, or for an answer.
            --  Close only when it has let go: the system gives the number of
            --  a closed socket to the next one.
            Link.Detach;
            Set_True (Work);
            Tcp_Sockets.Break_Off (Server);
            Wait_Idle;
            Tcp_Sockets.Close (Server);
         end if;
         Pause (Milliseconds => 100);
      end loop;
   end Reader;

   ------------
   -- Writer --
   ------------

   task body Writer is
      F      : Any_Frames.Any_Frame := Any_Frames.Null_Any_Frame;
      Status : Queueing.Take_Status := Queueing.Empty;
      --  F has yet to be sent while it is Taken.
      May    : Permission;
   begin
      loop
         Recover;
         if Status = Queueing.Empty then
            Transmit.Take (F, Status);
         end if;
         if Status = Queueing.Empty then
            Suspend_Until_True (Work);
         else
            Ask_To_Send (F, May);
            if May = Wait then
               Suspend_Until_True (Work);
            else
               Status := Queueing.Empty;
            end if;
         end if;
      end loop;
   end Writer;

   procedure Send (F : Any_Frames.Any_Frame; Status : out Send_Status)
   with Refined_Global => (In_Out => (Transmit.State, Work))
   is
      Result : Queueing.Put_Status;
   begin
      Transmit.Put (F, Result);
      Set_True (Work);
      Status :=
        (if Result = Queueing.Rejected_Full then Rejected_Full else Queued);
   end Send;

   procedure Wait_Frame
     (F : out Any_Frames.Any_Frame; Stamp : out Nanoseconds)
   with Refined_Global => (In_Out => (Receive.State, Receive.Wake_Up))
   is
   begin
      Receive.Wait (F, Stamp);
   end Wait_Frame;

   procedure Read_State (Now : out Controller_State)
   with Refined_Global => Link
   is
      Log : constant Fault_Notices.Fault_Log := Link.Faults;
   begin
      Now := Log.State;
   end Read_State;

   procedure Read_Faults (Log : out Fault_Notices.Fault_Log)
   with Refined_Global => Link
   is
   begin
      Log := Link.Faults;
   end Read_Faults;

   procedure Request_Recovery
   with Refined_Global => (In_Out => Work, Output => Recovery_Asked)
   is
   begin
      Recovery_Asked := True;
      Set_True (Work);
   end Request_Recovery;

   procedure Read_Counters (C : out Counters)
   with Refined_Global => (Transmit.State, Receive.State, Link)
   is
      Lost_Out : constant Event_Count := Transmit.Lost;
      Lost_In  : constant Event_Count := Receive.Lost;
   begin
      C          := Link.All_Counts;
      C.Lost_Out := Bus_Members.Sum (C.Lost_Out, Lost_Out);
      C.Lost_In  := Lost_In;
   end Read_Counters;

end Ravenchart.Can.Controllers;
