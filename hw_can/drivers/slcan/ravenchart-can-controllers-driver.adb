--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Driver "slcan": a server on 127.0.0.1 that speaks slcan to one client,
--  which represents the rest of the bus. Or the host of an slcan adapter on
--  the serial line that RAVENCHART_CAN_DEVICE names. With _ and the name of a
--  bus behind it, a variable is for that bus alone.
--
--  Guarantees   only whole, well-formed lines go to the client; a client that
--               stops reading delays the writer alone
--  Tasking      a reader, which waits for clients and their lines, and a
--               writer, which waits for the transmit queue
--  Timing       that of the client and of TCP: nothing here is real-time
--  Assumptions  ASM-005, the socket calls do what their specification states
--
--  Commands get no answer except the two queries, as the clients in use expect
--  none. There is no bus error in slcan: the state is Error_Active while a
--  client has the channel open, and Stopped otherwise. So no fault is ever
--  logged, and an adapter leaves bus-off as its firmware does.

with Ada.Real_Time;
with Ravenchart.Epochs;
with Ravenchart.Queues;
with Ravenchart.Can.Connections;
with Ravenchart.Can.Driver_Hosts;
with Ravenchart.Can.Ports;
with Ravenchart.Can.Serial_Lines;
with Ravenchart.Can.Slcan.Openings;
with Ravenchart.Can.Sockets;
with Ravenchart.Can.Tcp_Sockets;

separate (Ravenchart.Can.Controllers)
package body Driver is
   pragma Refined_State
     ((State => (Answers.State, Line.State, Line.Wake_Up, Reader, Writer)));

   use type Interfaces.Unsigned_8;
   use type Queueing.Take_Status;
   use type Slcan.Outcome;
   use type Sockets.Socket;

   type Answer is (Version, Serial_Number);
   --  The queries of a client.

   package Answers is new Queues
     (Element_Type => Answer,
      Null_Element => Version,
      Capacity     => 8,
      Ceiling      => Transmit_Ceiling,
      Policy       => Queueing.Reject_Newest);
   --  Answers for the writer, since only one task writes. A client gets no
   --  answer when there is no room.

   package Line is new Connections (Ceiling => Transmit_Ceiling);
   --  The connection to the client, whose channel is open while the state is
   --  Error_Active.

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Reader
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Serves one client after another.

   task Writer
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Writes the answers and the frames of the transmit queue.

   procedure Put_Answer (Item : Answer)
   with Global => (In_Out => (Answers.State, Upper.Wake_Up));
   --  Queue an answer.

   procedure Obey (Result : Slcan.Outcome; F : Any_Frames.Any_Frame)
   with
     Global =>
       (In_Out => (Answers.State, Upper.State, Upper.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  Execute a line of the client.

   procedure Serve (Client : Sockets.Socket)
   with
     Global =>
       (In_Out => (Answers.State, Upper.State, Upper.Wake_Up,
                   Sockets.Network),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  Read the client's lines until it disconnects.

   subtype Answer_Line is Tcp_Sockets.Octets (1 .. 6);

   function Text_Of (Item : Answer) return Answer_Line
   is (case Item is
         when Version       =>
           (Character'Pos ('V'), Character'Pos ('1'), Character'Pos ('0'),
            Character'Pos ('1'), Character'Pos ('3'),
            Slcan.Carriage_Return),
         when Serial_Number =>
           (Character'Pos ('N'), Character'Pos ('A'), Character'Pos ('1'),
            Character'Pos ('2'), Character'Pos ('3'),
            Slcan.Carriage_Return))
   with Global => null;
   --  The line of an answer.

   procedure Write_Answer (Item : Answer)
   with
     Global =>
       (In_Out => (Line.State, Line.Wake_Up, Sockets.Network));
   --  Write the answer, if there is a client.

   procedure Write_Frame (F : Any_Frames.Any_Frame)
   with
     Global =>
       (In_Out => (Line.State, Line.Wake_Up, Upper.State,
                   Sockets.Network));
   --  Write the frame and count it, if there is a client whose channel is
   --  open.

   Device_Variable : constant String := "RAVENCHART_CAN_DEVICE";
   --  The variable that names the serial line of an adapter.

   procedure Open_Server (Server : out Sockets.Socket)
   with Global => (In_Out => (Driver_Hosts.Console, Sockets.Network));
   --  Listen on the port that RAVENCHART_CAN_PORT names, or on one that the
   --  system chooses, and announce it on standard output.

   procedure Open_Serial (Client : out Sockets.Socket)
   with Global => (In_Out => (Driver_Hosts.Console, Sockets.Network));
   --  Open the serial line, set the bit rates of the slcan adapter, open its
   --  channel, and announce it on standard output. The digit that
   --  RAVENCHART_CAN_SPEED names takes precedence over the bit rate of the
   --  bus.

   -----------------
   -- Open_Server --
   -----------------

   procedure Open_Server (Server : out Sockets.Socket) is
      Asked    : Ports.Port;
      Given    : Ports.Port;
      Is_Sound : Boolean;
      Result   : Tcp_Sockets.Outcome;
   begin
      Server := Sockets.No_Socket;
      Ports.Read
        ("RAVENCHART_CAN_PORT", Bus_Name, Bus_Number, 0, Asked, Is_Sound);
      if Is_Sound then
         Tcp_Sockets.Open_Server (Asked, Server, Given, Result);
         case Result is
            when Tcp_Sockets.Opened    =>
               Driver_Hosts.Announce
                 ("slcan on 127.0.0.1:", Natural (Given));
            when Tcp_Sockets.None_Left =>
               Driver_Hosts.Complain
                 (Bus_Number, "no socket: the system has none left");
            when Tcp_Sockets.Refused   =>
               Driver_Hosts.Complain
                 (Bus_Number,
                  "port ",
                  Natural (Asked),
                  " cannot be opened: is it in use? trying again");
         end case;
      end if;
   end Open_Server;

   -----------------
   -- Open_Serial --
   -----------------

   procedure Open_Serial (Client : out Sockets.Socket) is
      Path       : String (1 .. Serial_Lines.Path_Limit);
      Path_Last  : Natural;
      Speed      : String (1 .. 2);
      Speed_Last : Natural;
      First      : Slcan.Openings.Opening_Text;
      First_Last : Natural;
      Result     : Serial_Lines.Outcome;
   begin
      Client := Sockets.No_Socket;
      Driver_Hosts.Read_Setting
        ("RAVENCHART_CAN_SPEED", Bus_Name, Speed, Speed_Last);
      if not Slcan.Openings.Is_Speed (Speed (1 .. Speed_Last)) then
         Driver_Hosts.Complain
           (Bus_Number, "RAVENCHART_CAN_SPEED must be a digit, 0 to 8");
         return;
      end if;
      Slcan.Openings.Format
        (Setting, Speed (1 .. Speed_Last), First, First_Last);
      Driver_Hosts.Read_Setting (Device_Variable, Bus_Name, Path, Path_Last);
      Serial_Lines.Open
        (Path (1 .. Path_Last), First (1 .. First_Last), Client, Result);
      case Result is
         when Serial_Lines.Opened    =>
            Driver_Hosts.Announce ("slcan on ", Path (1 .. Path_Last));
         when Serial_Lines.No_Device =>
            Driver_Hosts.Complain
              (Bus_Number,
               Path (1 .. Path_Last),
               " cannot be opened: trying again");
         when Serial_Lines.No_Line   =>
            Driver_Hosts.Complain
              (Bus_Number,
               Path (1 .. Path_Last),
               " is no serial line: trying again");
      end case;
   end Open_Serial;

   ----------------
   -- Put_Answer --
   ----------------

   procedure Put_Answer (Item : Answer) is
      Status : Queueing.Put_Status;
   begin
      pragma Warnings
        (GNATprove, Off, """Status"" is set by*",
         Reason => "the queue counts what it rejects");
      Answers.Put (Item, Status);
      pragma Warnings (GNATprove, On, """Status"" is set by*");
      Upper.Wake;
   end Put_Answer;

   ----------
   -- Obey --
   ----------

   procedure Obey (Result : Slcan.Outcome; F : Any_Frames.Any_Frame) is
      Now : Controller_State;
   begin
      case Result is
         when Slcan.Frame_Line =>
            Upper.Read_State (Now);
            if Now = Stopped or else not Any_Frames.Fits (F, Setting) then
               Upper.Count (Upper.Rejected_Line);
            else
               Upper.Receive (F);
            end if;
         when Slcan.Open_Channel =>
            Upper.Note (Error_Active);
         when Slcan.Close_Channel =>
            Upper.Note (Stopped);
         when Slcan.Version_Query =>
            Put_Answer (Version);
         when Slcan.Serial_Query =>
            Put_Answer (Serial_Number);
         when Slcan.Rejected_Line =>
            Upper.Count (Upper.Rejected_Line);
         when Slcan.Incomplete | Slcan.Other_Command | Slcan.Empty_Line =>
            null;
      end case;
   end Obey;

   -----------
   -- Serve --
   -----------

   procedure Serve (Client : Sockets.Socket) is
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
               Upper.Count (Upper.Rejected_Line);
            else
               Slcan.Feed (Parser, Bytes (I), Result, F);
               Obey (Result, F);
            end if;
         end loop;
      end loop;
   end Serve;

   ------------------
   -- Write_Answer --
   ------------------

   procedure Write_Answer (Item : Answer) is
      Client : Sockets.Socket;
      Done   : Boolean;
   begin
      Line.Begin_Use (Client);
      if Client /= Sockets.No_Socket then
         pragma Warnings
           (GNATprove, Off, """Done"" is set by*",
            Reason => "a client that has gone needs no answer");
         Tcp_Sockets.Send (Client, Text_Of (Item), Done);
         pragma Warnings (GNATprove, On, """Done"" is set by*");
      end if;
      Line.End_Use;
   end Write_Answer;

   -----------------
   -- Write_Frame --
   -----------------

   procedure Write_Frame (F : Any_Frames.Any_Frame) is
      Bytes  : Slcan.Line_Bytes;
      Last   : Slcan.Line_Length;
      Client : Sockets.Socket;
      Now    : Controller_State;
      Done   : Boolean := False;
   begin
      Slcan.Format_Line (F, Bytes, Last);
      Line.Begin_Use (Client);
      Upper.Read_State (Now);
      if Client /= Sockets.No_Socket and then Now /= Stopped then
         Tcp_Sockets.Send
           (Client, Tcp_Sockets.Octets (Bytes (1 .. Last)), Done);
      end if;
      Upper.Count (if Done then Upper.Sent else Upper.Lost_Out);
      Line.End_Use;
   end Write_Frame;

   ------------
   -- Reader --
   ------------

   task body Reader is
      Server : Sockets.Socket := Sockets.No_Socket;
      Client : Sockets.Socket;
      Serial : Boolean;
      Unused : String (1 .. 1);
      Last   : Natural;
   begin
      delay until Epochs.Start;
      --  Wait for Start: a client that came before the processors run would
      --  find no reader for its frames.
      Driver_Hosts.Read_Setting (Device_Variable, Bus_Name, Unused, Last);
      Serial := Last > 0;
      if not Serial then
         loop
            Open_Server (Server);
            exit when Server /= Sockets.No_Socket;
            Line.Pause (Milliseconds => 1_000);
         end loop;
      end if;
      loop
         if Serial then
            Open_Serial (Client);
         else
            Tcp_Sockets.Accept_Client (Server, Client);
         end if;
         if Client = Sockets.No_Socket then
            Line.Pause (Milliseconds => 100);
         else
            Line.Attach (Client);
            if Serial then
               Upper.Note (Error_Active);
            end if;
            Serve (Client);
            --  The writer may be waiting for this client: end its wait.
            Line.Detach;
            Upper.Note (Stopped);
            Tcp_Sockets.Break_Off (Client);
            Line.Wait_Unused;
            Sockets.Close (Client);
         end if;
      end loop;
   end Reader;

   ------------
   -- Writer --
   ------------

   task body Writer is
      Item   : Answer;
      F      : Any_Frames.Any_Frame;
      Status : Queueing.Take_Status;
   begin
      loop
         Answers.Take (Item, Status);
         if Status = Queueing.Taken then
            Write_Answer (Item);
         else
            Upper.Take_Queued (F, Status);
            if Status = Queueing.Taken then
               Write_Frame (F);
            else
               Upper.Wait_Work;
            end if;
         end if;
      end loop;
   end Writer;

end Driver;
