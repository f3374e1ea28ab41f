--  Driver "slcan": a server on 127.0.0.1 that speaks slcan to one client,
--  which stands for the rest of the bus; or the host of an slcan adapter on
--  the serial line that RAVENCHART_CAN_DEVICE names.
--
--  Guarantees   only whole, well-formed lines go to the client; a client that
--               stops reading delays the writer alone
--  Tasking      a reader, which waits for clients and their lines, and a
--               writer, which waits for the transmit queue
--  Timing       that of the client and of TCP: nothing here is real-time
--  Assumptions  ASM-005, the socket calls do what their spec says
--
--  Commands get no answer except the two queries, as the clients in use
--  expect none. There is no bus error in slcan: the state is Error_Active
--  while a client has the channel open, and Stopped otherwise. So no fault is
--  ever logged, and an adapter leaves bus-off as its firmware does.

with Ada.Real_Time;
with Ada.Synchronous_Task_Control;
with Ravenchart.Epochs;
with Ravenchart.Waiting_Queues;
with Ravenchart.Can.Received_Frames;
with Ravenchart.Can.Slcan;
with Ravenchart.Can.Tcp_Sockets;

package body Ravenchart.Can.Controllers
  with
    SPARK_Mode,
    Refined_State =>
      (State   => (Transmit.State, Receive.State, Link, Reader, Writer),
       Wake_Up => (Transmit.Wake_Up, Receive.Wake_Up, Let_Go, Asked))
is
   pragma Warnings
     (GNATprove, Off, "no Always_Terminates aspect available*",
      Reason => "ASM-008, the library does not say it of suspension objects");
   pragma Warnings
     (GNATprove, Off, "assuming * always terminates",
      Reason => "ASM-008, the library does not say it of suspension objects");

   use Ada.Synchronous_Task_Control;
   use type Ada.Real_Time.Time;
   use type Interfaces.Unsigned_8;
   use type Queueing.Put_Status;
   use type Slcan.Outcome;
   use type Tcp_Sockets.Socket;

   type Line_Kind is (Frame_Line, Version_Answer, Serial_Answer);
   --  What the writer can be asked to write.

   type Outgoing is record
      Kind : Line_Kind := Frame_Line;
      F    : Any_Frames.Any_Frame;
   end record;
   --  Answers go the way of the frames, so that one task alone writes.

   package Transmit is new Waiting_Queues
     (Element_Type => Outgoing,
      Null_Element => (others => <>),
      Capacity     => Transmit_Depth,
      Ceiling      => Transmit_Ceiling);

   package Receive is new Received_Frames
     (Capacity => Receive_Depth, Ceiling => Receive_Ceiling);

   type Channel_State is (Closed, Open);
   --  Whether the client wants frames.

   protected Link
     with Priority => Transmit_Ceiling
   is
      procedure Attach (New_Client : Tcp_Sockets.Socket);
      --  A client has come; its channel is closed at first.

      procedure Set_Channel (To : Channel_State);
      --  The client has opened or closed its channel.

      procedure Detach;
      --  The client has gone: no further line is begun.

      procedure Begin_Line
        (Kind : Line_Kind; To : out Tcp_Sockets.Socket);
      --  The client that a line may go to, or No_Socket.

      procedure End_Line (Kind : Line_Kind; Done : Boolean);
      --  The line was written, or not.

      procedure Count_Received;
      --  A frame was accepted.

      procedure Count_Rejected;
      --  A line was not understood, or its frame is not for this bus, or came
      --  while the channel was closed.

      function Is_Idle return Boolean;
      --  The writer uses no client.

      function State_Now return Controller_State;

      function Faults return Fault_Notices.Fault_Log;

      function All_Counts return Counters;

   private
      Client  : Tcp_Sockets.Socket := Tcp_Sockets.No_Socket;
      Channel : Channel_State := Closed;
      Idle    : Boolean := True;
      --  False while the writer uses the client's socket.
      Counts  : Counters;
   end Link;

   Let_Go : Suspension_Object;
   --  True when the writer may have become idle since the reader looked.

   Asked : Boolean := False
   with Atomic;
   --  True when recovery was requested. No command of slcan passes it on.

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Reader
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Serves one client after another.

   task Writer
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Writes what is in the transmit queue.

   procedure Put_Answer (Kind : Line_Kind)
   with Global => (In_Out => (Transmit.State, Transmit.Wake_Up));
   --  Queue an answer; when there is no room the client gets none.

   procedure Obey (Result : Slcan.Outcome; F : Any_Frames.Any_Frame)
   with
     Global =>
       (In_Out => (Link, Transmit.State, Transmit.Wake_Up,
                   Receive.State, Receive.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  Do what a line of the client says.

   procedure Serve (Client : Tcp_Sockets.Socket)
   with
     Global =>
       (In_Out => (Link, Transmit.State, Transmit.Wake_Up,
                   Receive.State, Receive.Wake_Up,
                   Tcp_Sockets.Network),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  Take the client's lines until it goes.

   procedure Wait_Idle
   with Global => (In_Out => Let_Go, Input => Link);
   --  Suspend the reader until the writer uses no client.

   procedure Format
     (Item : Outgoing;
      Line : out Slcan.Line_Bytes;
      Last : out Slcan.Line_Length)
   with Global => null;
   --  The line that stands for Item.

   procedure Pause (Milliseconds : Positive)
   with Global => (Input => Ada.Real_Time.Clock_Time);
   --  Let time pass before a call that failed is tried again.

   protected body Link is

      procedure Attach (New_Client : Tcp_Sockets.Socket) is
      begin
         Client  := New_Client;
         Channel := Closed;
      end Attach;

      procedure Set_Channel (To : Channel_State) is
      begin
         Channel := To;
      end Set_Channel;

      procedure Detach is
      begin
         Client  := Tcp_Sockets.No_Socket;
         Channel := Closed;
      end Detach;

      procedure Begin_Line
        (Kind : Line_Kind; To : out Tcp_Sockets.Socket) is
      begin
         To :=
           (if Kind = Frame_Line and then Channel = Closed
            then Tcp_Sockets.No_Socket
            else Client);
         Idle := To = Tcp_Sockets.No_Socket;
      end Begin_Line;

      procedure End_Line (Kind : Line_Kind; Done : Boolean) is
      begin
         Idle := True;
         if Kind = Frame_Line then
            if Done then
               Counts.Sent := Next (Counts.Sent);
            else
               Counts.Lost_Out := Next (Counts.Lost_Out);
            end if;
         end if;
      end End_Line;

      procedure Count_Received is
      begin
         Counts.Received := Next (Counts.Received);
      end Count_Received;

      procedure Count_Rejected is
      begin
         Counts.Rejected_Lines := Next (Counts.Rejected_Lines);
      end Count_Rejected;

      function Is_Idle return Boolean
      is (Idle);

      function State_Now return Controller_State
      is (if Channel = Open then Error_Active else Stopped);

      function Faults return Fault_Notices.Fault_Log
      is (Fault_Notices.Noted
            (Fault_Notices.Fault_Log'(others => <>), State_Now));

      function All_Counts return Counters
      is (Counts);

   end Link;

   ----------------
   -- Put_Answer --
   ----------------

   procedure Put_Answer (Kind : Line_Kind) is
      Status : Queueing.Put_Status;
   begin
      pragma Warnings
        (GNATprove, Off, """Status"" is set by*",
         Reason => "the queue counts what it rejects");
      Transmit.Put ((Kind, Any_Frames.Null_Any_Frame), Status);
      pragma Warnings (GNATprove, On, """Status"" is set by*");
   end Put_Answer;

   ----------
   -- Obey --
   ----------

   procedure Obey (Result : Slcan.Outcome; F : Any_Frames.Any_Frame) is
      Now : Controller_State;
   begin
      case Result is
         when Slcan.Frame_Line =>
            Now := Link.State_Now;
            if Now = Stopped or else not Any_Frames.Fits (F, Setting) then
               Link.Count_Rejected;
            elsif Accepts (Any_Frames.Id (F), Any_Frames.Format (F)) then
               Link.Count_Received;
               Receive.Put (F);
            end if;
         when Slcan.Open_Channel =>
            Link.Set_Channel (Open);
         when Slcan.Close_Channel =>
            Link.Set_Channel (Closed);
         when Slcan.Version_Query =>
            Put_Answer (Version_Answer);
         when Slcan.Serial_Query =>
            Put_Answer (Serial_Answer);
         when Slcan.Rejected_Line =>
            Link.Count_Rejected;
         when Slcan.Incomplete | Slcan.Other_Command | Slcan.Empty_Line =>
            null;
      end case;
   end Obey;

   -----------
   -- Serve --
   -----------

   procedure Serve (Client : Tcp_Sockets.Socket) is
      Parser : Slcan.Parser;
      Bytes  : Tcp_Sockets.Chunk;
      Last   : Tcp_Sockets.Chunk_Length;
      Result : Slcan.Outcome;
      F      : Any_Frames.Any_Frame;
   begin
      loop
         Tcp_Sockets.Receive (Client, Bytes, Last);
         exit when Last = 0;
         for I in 1 .. Last loop
            if Bytes (I) = Slcan.Bell then
               Link.Count_Rejected;
            else
               Slcan.Feed (Parser, Bytes (I), Result, F);
               Obey (Result, F);
            end if;
         end loop;
      end loop;
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

   ------------
   -- Format --
   ------------

   procedure Format
     (Item : Outgoing;
      Line : out Slcan.Line_Bytes;
      Last : out Slcan.Line_Length)
   is
      procedure Spell (Text : String)
      with
        Global => (Output => Last, In_Out => Line),
        Pre    => Text'First = 1 and then Text'Length < Slcan.Line_Limit;
      --  Make Text the line.

      procedure Spell (Text : String) is
      begin
         for I in Text'Range loop
            Line (I) := Character'Pos (Text (I));
         end loop;
         Last        := Text'Length + 1;
         Line (Last) := Slcan.Carriage_Return;
      end Spell;

   begin
      Slcan.Format_Line (Item.F, Line, Last);
      case Item.Kind is
         when Frame_Line =>
            null;
         when Version_Answer =>
            Spell ("V1013");
         when Serial_Answer =>
            Spell ("NA123");
      end case;
   end Format;

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
      Server : Tcp_Sockets.Socket := Tcp_Sockets.No_Socket;
      Client : Tcp_Sockets.Socket;
      Serial : Boolean;
   begin
      delay until Epochs.Start;
      --  A client that came before the processors run would find nobody
      --  to take its frames.
      Tcp_Sockets.Ask_For_Device (Serial);
      if not Serial then
         loop
            Tcp_Sockets.Open_Server (Server);
            exit when Server /= Tcp_Sockets.No_Socket;
            Pause (Milliseconds => 1_000);
         end loop;
      end if;
      loop
         if Serial then
            Tcp_Sockets.Open_Device (Setting, Client);
         else
            Tcp_Sockets.Accept_Client (Server, Client);
         end if;
         if Client = Tcp_Sockets.No_Socket then
            Pause (Milliseconds => 100);
         else
            Link.Attach (Client);
            if Serial then
               Link.Set_Channel (Open);
            end if;
            Serve (Client);
            --  The writer may be waiting for this client. End its wait, and
            --  close only when it has let go: the system gives the number of
            --  a closed socket to the next one.
            Link.Detach;
            Tcp_Sockets.Break_Off (Client);
            Wait_Idle;
            Tcp_Sockets.Close (Client);
         end if;
      end loop;
   end Reader;

   ------------
   -- Writer --
   ------------

   task body Writer is
      Item   : Outgoing;
      Line   : Slcan.Line_Bytes;
      Last   : Slcan.Line_Length;
      Client : Tcp_Sockets.Socket;
      Done   : Boolean;
   begin
      loop
         Transmit.Wait (Item);
         Format (Item, Line, Last);
         Link.Begin_Line (Item.Kind, Client);
         Done := False;
         if Client /= Tcp_Sockets.No_Socket then
            Tcp_Sockets.Send
              (Client, Tcp_Sockets.Octets (Line (1 .. Last)), Done);
         end if;
         Link.End_Line (Item.Kind, Done);
         Set_True (Let_Go);
      end loop;
   end Writer;

   procedure Send (F : Any_Frames.Any_Frame; Status : out Send_Status)
   with Refined_Global => (In_Out => (Transmit.State, Transmit.Wake_Up))
   is
      Result : Queueing.Put_Status;
   begin
      Transmit.Put ((Frame_Line, F), Result);
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
   begin
      Now := Link.State_Now;
   end Read_State;

   procedure Read_Faults (Log : out Fault_Notices.Fault_Log)
   with Refined_Global => Link
   is
   begin
      Log := Link.Faults;
   end Read_Faults;

   procedure Request_Recovery
   with Refined_Global => (Output => Asked)
   is
   begin
      Asked := True;
   end Request_Recovery;

   procedure Read_Counters (C : out Counters)
   with Refined_Global => (Transmit.State, Receive.State, Link)
   is
      Lost_Out : constant Event_Count := Transmit.Lost;
      Lost_In  : constant Event_Count := Receive.Lost;
   begin
      C          := Link.All_Counts;
      C.Lost_Out :=
        (if Lost_Out > Event_Count'Last - C.Lost_Out then Event_Count'Last
         else C.Lost_Out + Lost_Out);
      C.Lost_In  := Lost_In;
   end Read_Counters;

end Ravenchart.Can.Controllers;
