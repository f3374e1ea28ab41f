--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Driver "socketcan": a CAN interface of Linux, through a raw socket.
--
--  Guarantees   frames go to the interface in the order sent; a frame without
--               room there waits, and so do those behind it
--  Tasking      a reader, which waits for frames and error reports, and a
--               writer, which waits for the transmit queue
--  Timing       that of Linux: nothing here is real-time
--  Assumptions  ASM-011, the socket calls do what their specification states
--
--  The state follows the error reports: Error_Active when a frame was sent or
--  received, Stopped while the interface is down or missing. The interface
--  leaves bus-off by its own setting, restart-ms: a raw socket cannot request
--  it.

with Ada.Real_Time;
with Ravenchart.Epochs;
with Ravenchart.Can.Connections;
with Ravenchart.Can.Driver_Hosts;
with Ravenchart.Can.Raw_Sockets;
with Ravenchart.Can.Socket_Frames;
with Ravenchart.Can.Sockets;

separate (Ravenchart.Can.Controllers)
package body Driver is
   pragma Refined_State
     ((State => (Line.State, Line.Wake_Up, Reader, Writer)));

   use type Raw_Sockets.Outcome;
   use type Sockets.Socket;

   package Line is new Connections (Ceiling => Transmit_Ceiling);
   --  The connection to the interface.

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Reader
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Reads the frames that the interface receives.

   task Writer
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Sends the frames of the transmit queue.

   procedure Note_Report (Report : Socket_Frames.Item)
   with
     Global => (In_Out => Upper.State),
     Pre    => Socket_Frames.Is_Error (Report);
   --  Note the state of the controller from a report of the interface.

   procedure Take (Item : Socket_Frames.Item)
   with
     Global =>
       (In_Out => (Upper.State, Upper.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  A frame or an error report has come.

   procedure Serve (Bus : Sockets.Socket)
   with
     Global =>
       (In_Out => (Upper.State, Upper.Wake_Up, Sockets.Network),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  Receive until the socket is no longer usable.

   procedure Put (F : Any_Frames.Any_Frame; Sent : out Boolean)
   with
     Global =>
       (In_Out => (Line.State, Line.Wake_Up, Upper.State,
                   Driver_Hosts.Console, Sockets.Network));
   --  Try to send F once; Sent is False when it must wait.

   subtype Interface_Name is String (1 .. Raw_Sockets.Name_Limit);

   procedure Read_Name (Name : out Interface_Name; Last : out Positive)
   with Global => null, Post => Last <= Interface_Name'Last;
   --  The interface that RAVENCHART_CAN_INTERFACE names, or can0 for the first
   --  bus of a node, can1 for its second one, and so on.

   procedure Open (Bus : out Sockets.Socket)
   with Global => (In_Out => (Driver_Hosts.Console, Sockets.Network));
   --  A socket on that interface, announced on standard output; No_Socket,
   --  with one message on standard error, where there is none.

   ---------------
   -- Read_Name --
   ---------------

   procedure Read_Name (Name : out Interface_Name; Last : out Positive) is
      Digit   : constant Character :=
        Character'Val (Character'Pos ('0') + Bus_Number - 1);
      Default : constant String := "can" & Digit;
      Length  : Natural;
   begin
      Driver_Hosts.Read_Setting
        ("RAVENCHART_CAN_INTERFACE", Bus_Name, Name, Length);
      if Length = 0 then
         Length := Default'Length;
         Name (1 .. Length) := Default;
      end if;
      Last := Length;
   end Read_Name;

   ----------
   -- Open --
   ----------

   procedure Open (Bus : out Sockets.Socket) is
      Name   : Interface_Name;
      Last   : Positive;
      Result : Raw_Sockets.Opening;
   begin
      Read_Name (Name, Last);
      Raw_Sockets.Open (Name (1 .. Last), Setting.Takes_Fd, Bus, Result);
      case Result is
         when Raw_Sockets.Joined       =>
            Driver_Hosts.Announce ("socketcan on ", Name (1 .. Last));
         when Raw_Sockets.No_Can       =>
            Driver_Hosts.Complain
              (Bus_Number, "this system has no SocketCAN; trying again");
         when Raw_Sockets.No_Interface =>
            Driver_Hosts.Complain
              (Bus_Number,
               "there is no CAN interface ",
               Name (1 .. Last),
               "; trying again");
      end case;
   end Open;

   -----------------
   -- Note_Report --
   -----------------

   procedure Note_Report (Report : Socket_Frames.Item) is
      Before : Controller_State;
      After  : Controller_State;
   begin
      Upper.Read_State (Before);
      After := Socket_Frames.State_After (Report, Before);
      if After /= Before then
         Upper.Note (After);
      end if;
      if Socket_Frames.Has_Counters (Report) then
         Upper.Note_Errors
           (Transmit => Error_Count (Report.Data (6)),
            Receive  => Error_Count (Report.Data (7)));
      end if;
   end Note_Report;

   ----------
   -- Take --
   ----------

   procedure Take (Item : Socket_Frames.Item) is
   begin
      if Socket_Frames.Is_Error (Item) then
         Note_Report (Item);
      elsif Socket_Frames.Is_Frame (Item) then
         Upper.Note_Traffic;
         Upper.Receive (Socket_Frames.Any_Frame_Of (Item));
      end if;
   end Take;

   -----------
   -- Serve --
   -----------

   procedure Serve (Bus : Sockets.Socket) is
      Item   : Socket_Frames.Item;
      Result : Raw_Sockets.Outcome;
   begin
      loop
         Raw_Sockets.Receive (Bus, Item, Result);
         exit when Result = Raw_Sockets.Gone;
         if Result = Raw_Sockets.Done then
            Take (Item);
         else
            Upper.Note (Stopped);
            Line.Pause (Milliseconds => 100);
         end if;
      end loop;
   end Serve;

   ---------
   -- Put --
   ---------

   procedure Put (F : Any_Frames.Any_Frame; Sent : out Boolean) is
      Bus    : Sockets.Socket;
      Result : Raw_Sockets.Outcome := Raw_Sockets.Refused;
      Name   : Interface_Name;
      Last   : Positive;
   begin
      Line.Begin_Use (Bus);
      if Bus /= Sockets.No_Socket then
         Raw_Sockets.Send (Bus, Socket_Frames.Item_Of (F), Result);
      end if;
      case Result is
         when Raw_Sockets.Done                    =>
            Upper.Count (Upper.Sent);
            Upper.Note_Traffic;
         when Raw_Sockets.Busy                    =>
            null;
         when Raw_Sockets.Refused                 =>
            Upper.Count (Upper.Lost_Out);
            Read_Name (Name, Last);
            Driver_Hosts.Complain
              (Bus_Number,
               Name (1 .. Last),
               " is not set up for CAN FD (fd on)");
         when Raw_Sockets.Down | Raw_Sockets.Gone =>
            Upper.Count (Upper.Lost_Out);
            Upper.Note (Stopped);
      end case;
      Line.End_Use;
      Sent := Result /= Raw_Sockets.Busy;
   end Put;

   ------------
   -- Reader --
   ------------

   task body Reader is
      Bus : Sockets.Socket;
   begin
      delay until Epochs.Start;
      --  Wait for Start: a frame that came before the processors run would
      --  find no reader.
      loop
         Open (Bus);
         if Bus = Sockets.No_Socket then
            Line.Pause (Milliseconds => 1_000);
         else
            Line.Attach (Bus);
            Upper.Note (Error_Active);
            Serve (Bus);
            Line.Detach;
            Line.Wait_Unused;
            Upper.Note (Stopped);
            Sockets.Close (Bus);
         end if;
      end loop;
   end Reader;

   ------------
   -- Writer --
   ------------

   task body Writer is
      F    : Any_Frames.Any_Frame;
      Sent : Boolean;
   begin
      loop
         Upper.Wait_Queued (F);
         loop
            Put (F, Sent);
            exit when Sent;
            Line.Pause (Milliseconds => 1);
         end loop;
      end loop;
   end Writer;

end Driver;
