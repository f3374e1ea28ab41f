--  Driver "socketcan": a CAN interface of Linux, through a raw socket.
--
--  Guarantees   frames go to the interface in the order sent; one that it has
--               no room for waits, and those behind it
--  Tasking      a reader, which waits for frames and error reports, and a
--               writer, which waits for the transmit queue
--  Timing       that of Linux: nothing here is real-time
--  Assumptions  ASM-011, the socket calls do what their spec says
--
--  The state follows the error reports: Error_Active when something was
--  sent or received, Stopped while the interface is down or not there. The
--  interface leaves bus-off by its own setting, restart-ms: a raw socket has
--  no way to ask for it.

with Ada.Real_Time;
with Ada.Synchronous_Task_Control;
with Ravenchart.Epochs;
with Ravenchart.Waiting_Queues;
with Ravenchart.Can.Raw_Sockets;
with Ravenchart.Can.Received_Frames;
with Ravenchart.Can.Socket_Frames;

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
   use type Queueing.Put_Status;
   use type Raw_Sockets.Outcome;
   use type Raw_Sockets.Socket;

   package Transmit is new Waiting_Queues
     (Element_Type => Any_Frames.Any_Frame,
      Null_Element => Any_Frames.Null_Any_Frame,
      Capacity     => Transmit_Depth,
      Ceiling      => Transmit_Ceiling);

   package Receive is new Received_Frames
     (Capacity => Receive_Depth, Ceiling => Receive_Ceiling);

   protected Link
     with Priority => Transmit_Ceiling
   is
      procedure Attach (To : Raw_Sockets.Socket);
      --  There is a socket.

      procedure Detach;
      --  There is none any more: no further send is begun.

      procedure Begin_Send (To : out Raw_Sockets.Socket);
      --  The socket that a frame may go to, or No_Socket.

      procedure End_Send (Result : Raw_Sockets.Outcome);
      --  What became of it; No_Socket is let go.

      procedure Count_Lost;
      --  A frame was given up, as there is nothing to send it to.

      procedure Count_Received;
      --  A frame was accepted.

      procedure Note_Down;
      --  The interface is down.

      procedure Note_Up;
      --  Something has come from the bus.

      procedure Note_Report (Report : Socket_Frames.Item);
      --  How the controller stands now.

      function Is_Idle return Boolean;
      --  The writer uses no socket.

      function Faults return Fault_Notices.Fault_Log;

      function All_Counts return Counters;

   private
      Bus    : Raw_Sockets.Socket := Raw_Sockets.No_Socket;
      Idle   : Boolean := True;
      --  False while the writer uses the socket.
      Log    : Fault_Notices.Fault_Log;
      Counts : Counters;
   end Link;

   Let_Go : Suspension_Object;
   --  True when the writer may have become idle since the reader looked.

   Asked : Boolean := False
   with Atomic;
   --  True when recovery was requested. No call of a socket passes it on.

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Reader
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Takes what the interface receives.

   task Writer
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Sends what is in the transmit queue.

   procedure Take (Item : Socket_Frames.Item)
   with
     Global =>
       (In_Out => (Link, Receive.State, Receive.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  A frame or an error report has come.

   procedure Serve (Bus : Raw_Sockets.Socket)
   with
     Global =>
       (In_Out => (Link, Receive.State, Receive.Wake_Up,
                   Raw_Sockets.Network),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  Take what comes until the socket is of no use any more.

   procedure Put (F : Any_Frames.Any_Frame; Sent : out Boolean)
   with
     Global =>
       (In_Out => (Link, Let_Go, Raw_Sockets.Network));
   --  Try to send F once; Sent is False when it must wait.

   procedure Wait_Idle
   with Global => (In_Out => Let_Go, Input => Link);
   --  Suspend the reader until the writer uses no socket.

   procedure Pause (Milliseconds : Positive)
   with Global => (Input => Ada.Real_Time.Clock_Time);
   --  Let time pass before a call that failed is tried again.

   protected body Link is

      procedure Attach (To : Raw_Sockets.Socket) is
      begin
         Bus := To;
         Log := Fault_Notices.Noted (Log, Error_Active);
      end Attach;

      procedure Detach is
      begin
         Bus := Raw_Sockets.No_Socket;
         Log := Fault_Notices.Noted (Log, Stopped);
      end Detach;

      procedure Begin_Send (To : out Raw_Sockets.Socket) is
      begin
         To   := Bus;
         Idle := To = Raw_Sockets.No_Socket;
      end Begin_Send;

      procedure End_Send (Result : Raw_Sockets.Outcome) is
      begin
         Idle := True;
         case Result is
            when Raw_Sockets.Done =>
               Counts.Sent := Next (Counts.Sent);
               if Log.State = Stopped then
                  Log := Fault_Notices.Noted (Log, Error_Active);
               end if;
            when Raw_Sockets.Busy =>
               null;
            when Raw_Sockets.Refused =>
               Counts.Lost_Out := Next (Counts.Lost_Out);
            when Raw_Sockets.Down | Raw_Sockets.Gone =>
               Counts.Lost_Out := Next (Counts.Lost_Out);
               Log             := Fault_Notices.Noted (Log, Stopped);
         end case;
      end End_Send;

      procedure Count_Lost is
      begin
         Counts.Lost_Out := Next (Counts.Lost_Out);
      end Count_Lost;

      procedure Count_Received is
      begin
         Counts.Received := Next (Counts.Received);
      end Count_Received;

      procedure Note_Down is
      begin
         Log := Fault_Notices.Noted (Log, Stopped);
      end Note_Down;

      procedure Note_Up is
      begin
         if Log.State = Stopped then
            Log := Fault_Notices.Noted (Log, Error_Active);
         end if;
      end Note_Up;

      procedure Note_Report (Report : Socket_Frames.Item) is
      begin
         Log :=
           Fault_Notices.Noted
             (Log, Socket_Frames.State_After (Report, Log.State));
         if Socket_Frames.Has_Counters (Report) then
            Counts.Transmit_Errors := Error_Count (Report.Data (6));
            Counts.Receive_Errors  := Error_Count (Report.Data (7));
         end if;
      end Note_Report;

      function Is_Idle return Boolean
      is (Idle);

      function Faults return Fault_Notices.Fault_Log
      is (Log);

      function All_Counts return Counters
      is (Counts);

   end Link;

   ----------
   -- Take --
   ----------

   procedure Take (Item : Socket_Frames.Item) is
      F : Any_Frames.Any_Frame;
   begin
      if Socket_Frames.Is_Error (Item) then
         Link.Note_Report (Item);
      elsif Socket_Frames.Is_Frame (Item) then
         Link.Note_Up;
         F := Socket_Frames.Any_Frame_Of (Item);
         if Any_Frames.Fits (F, Setting)
           and then Accepts (Any_Frames.Id (F), Any_Frames.Format (F))
         then
            Link.Count_Received;
            Receive.Put (F);
         end if;
      end if;
   end Take;

   -----------
   -- Serve --
   -----------

   procedure Serve (Bus : Raw_Sockets.Socket) is
      Item   : Socket_Frames.Item;
      Result : Raw_Sockets.Outcome;
   begin
      loop
         Raw_Sockets.Receive (Bus, Item, Result);
         exit when Result = Raw_Sockets.Gone;
         if Result = Raw_Sockets.Done then
            Take (Item);
         else
            Link.Note_Down;
            Pause (Milliseconds => 100);
         end if;
      end loop;
   end Serve;

   ---------
   -- Put --
   ---------

   procedure Put (F : Any_Frames.Any_Frame; Sent : out Boolean) is
      Bus    : Raw_Sockets.Socket;
      Result : Raw_Sockets.Outcome;
   begin
      Link.Begin_Send (Bus);
      if Bus = Raw_Sockets.No_Socket then
         Link.Count_Lost;
         Sent := True;
      else
         Raw_Sockets.Send (Bus, Socket_Frames.Item_Of (F), Result);
         Link.End_Send (Result);
         Set_True (Let_Go);
         Sent := Result /= Raw_Sockets.Busy;
      end if;
   end Put;

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
      Bus : Raw_Sockets.Socket;
   begin
      delay until Epochs.Start;
      --  Frames that come before the processors run would find nobody.
      loop
         Raw_Sockets.Open (Setting.Takes_Fd, Bus);
         if Bus = Raw_Sockets.No_Socket then
            Pause (Milliseconds => 1_000);
         else
            Link.Attach (Bus);
            Serve (Bus);
            --  Close only when the writer has let go: the system gives the
            --  number of a closed socket to the next one.
            Link.Detach;
            Wait_Idle;
            Raw_Sockets.Close (Bus);
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
         Transmit.Wait (F);
         loop
            Put (F, Sent);
            exit when Sent;
            Pause (Milliseconds => 1);
         end loop;
      end loop;
   end Writer;

   procedure Send (F : Any_Frames.Any_Frame; Status : out Send_Status)
   with Refined_Global => (In_Out => (Transmit.State, Transmit.Wake_Up))
   is
      Result : Queueing.Put_Status;
   begin
      Transmit.Put (F, Result);
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
   with Refined_Global => (Output => Asked)
   is
   begin
      Asked := True;
   end Request_Recovery;

   procedure Read_Counters (C : out Counters)
   with Refined_Global => (Transmit.State, Receive.State, Link)
   is
      Not_Queued : constant Event_Count := Transmit.Lost;
      Lost_In    : constant Event_Count := Receive.Lost;
   begin
      C          := Link.All_Counts;
      C.Lost_Out :=
        (if Not_Queued > Event_Count'Last - C.Lost_Out then Event_Count'Last
         else C.Lost_Out + Not_Queued);
      C.Lost_In  := Lost_In;
   end Read_Counters;

end Ravenchart.Can.Controllers;
