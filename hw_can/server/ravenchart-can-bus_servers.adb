--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces;
with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Buses;
with Ravenchart.Can.Fault_Confinement;
with Ravenchart.Can.Transmit_Buffers;

package body Ravenchart.Can.Bus_Servers
  with SPARK_Mode
is
   use type Bus_Frames.Bus_Frame_Family;
   use type Buses.Ending;
   use type Interfaces.Unsigned_32;

   function Is_Due (A : Agenda; Now : Nanoseconds) return Boolean
   is (A.Next <= A.Count and then A.Events (A.Next).Start <= Now)
   with Global => null;
   --  Is an event of the line due by then?

   function First (A : Agenda; Begun : Nanoseconds) return Nanoseconds
   is (if Is_Due (A, Begun) then A.Events (A.Next).Start else Begun)
   with Global => null;
   --  The time of the next event of the line, if it is due by Begun; else
   --  Begun.

   procedure Apply_Next (N : in out Networks.Network; A : in out Agenda)
   with
     Global => null,
     Pre    => A.Next <= A.Count;
   --  Apply the next event to the line.

   function Holds
     (B : Transmit_Buffers.Buffer; Tag : Interfaces.Unsigned_32)
      return Boolean
   is (for some I in 1 .. Transmit_Buffers.Count (B) =>
         Transmit_Buffers.Item (B, I).Tag = Tag)
   with Global => null;
   --  Is a request with this number still to be sent?

   function Is_Witness
     (N : Networks.Network; C : Node_Index; Result : Buses.Outcome)
      return Boolean
   is (Result.Ended = Buses.Broken
       and then N.Bus.Nodes (C).Segment = N.Bus.Nodes (Result.Winner).Segment)
   with Global => null;
   --  Was there an error frame on the bus of node C?

   procedure Ask
     (To  : in out Bus_Clients.Client;
      N   : in out Networks.Network;
      C   : Node_Index;
      R   : Bus_Records.Request;
      Now : Nanoseconds)
   with Global => null;
   --  Client C requests to send a frame.

   procedure Publish
     (To      : in out Bus_Clients.Client;
      N       : in out Networks.Network;
      C       : Node_Index;
      Result  : Buses.Outcome;
      Receipt : Networks.Receipt;
      Fault   : Bus_Faults.Fault)
   with Global => null;
   --  Send client C the records of Result. When its node is bus-off, refuse
   --  its open requests.

   procedure Write_Down (Log : in out Journal; Result : Buses.Outcome)
   with Global => null;
   --  Keep the record of a frame that a node received, or of an error frame.

   procedure Carry
     (Clients : in out Client_List;
      N       : in out Networks.Network;
      Plan    : in out Fault_Plans.Plan;
      Log     : in out Journal;
      M       : Networks.Moment)
   with
     Global => null,
     Pre    =>
       M.Start in N.Bus.Free_At (M.Segment) .. Buses.Last_Start;
   --  Carry out what begins on the bus at M, and send the records of it.

   ----------------
   -- Apply_Next --
   ----------------

   procedure Apply_Next (N : in out Networks.Network; A : in out Agenda) is
   begin
      Line_Events.Apply (N, A.Events (A.Next));
      A.Next := A.Next + 1;
   end Apply_Next;

   ---------
   -- Ask --
   ---------

   procedure Ask
     (To  : in out Bus_Clients.Client;
      N   : in out Networks.Network;
      C   : Node_Index;
      R   : Bus_Records.Request;
      Now : Nanoseconds)
   is
      Status : Send_Status;
   begin
      if Holds (N.Buffers (C), R.Number) then
         Bus_Clients.End_With (To, Bus_Records.Malformed);
      elsif R.Frame.Family = Bus_Frames.Flexible and then not To.Takes_Fd then
         Bus_Clients.Refuse (To, R.Number, Bus_Records.Not_Supported);
      elsif not Takes_Part (N.Bus.Nodes (C)) then
         Bus_Clients.Refuse (To, R.Number, Bus_Records.Is_Bus_Off);
      else
         Networks.Submit
           (N, C, (Frame => R.Frame, Tag => R.Number, Since => Now), Status);
         if Status = Rejected_Full then
            Bus_Clients.Refuse (To, R.Number, Bus_Records.No_Room);
         end if;
      end if;
   end Ask;

   -------------
   -- Publish --
   -------------

   procedure Publish
     (To      : in out Bus_Clients.Client;
      N       : in out Networks.Network;
      C       : Node_Index;
      Result  : Buses.Outcome;
      Receipt : Networks.Receipt;
      Fault   : Bus_Faults.Fault)
   is
      Node : constant Fault_Confinement.Node := N.Bus.Nodes (C).Confinement;
   begin
      Bus_Clients.Tell_Frame (To, C, Result, Receipt.Tag, Fault);
      if not Bus_Clients.Knows (To, Node) then
         To.Last := Bus_Clients.Time_Heard (To, C, Result, Fault);
         if Is_Witness (N, C, Result) then
            Bus_Clients.Tell_Error (To, Result.Error.Kind);
         end if;
         Bus_Clients.Tell_State (To, Node);
         if Fault_Confinement.State (Node) = Bus_Off then
            Bus_Clients.Refuse_All (To, N.Buffers (C));
            Networks.Withdraw (N, C);
         end if;
      end if;
   end Publish;

   ----------------
   -- Write_Down --
   ----------------

   procedure Write_Down (Log : in out Journal; Result : Buses.Outcome) is

      procedure Put (Bytes : Bus_Records.Image)
      with Global => (Input => Result, In_Out => Log);

      procedure Put (Bytes : Bus_Records.Image) is
      begin
         if Log.Kept and then Log.Records.Count < Bus_Queues.Depth then
            Bus_Queues.Put
              (Log.Records, (Bytes => Bytes, Due => Result.Finish));
         end if;
      end Put;

   begin
      if Result.Ended = Buses.Whole
        or else (for some Heard of Result.Heard => Heard)
      then
         Put (Bus_Records.Frame_Record (Result.Frame, Result.Finish));
      end if;
      if Result.Ended = Buses.Broken then
         Put (Bus_Clients.Report (Result.Error.Kind, Result.Finish));
      end if;
   end Write_Down;

   -----------
   -- Carry --
   -----------

   procedure Carry
     (Clients : in out Client_List;
      N       : in out Networks.Network;
      Plan    : in out Fault_Plans.Plan;
      Log     : in out Journal;
      M       : Networks.Moment)
   is
      Fault    : Bus_Faults.Fault;
      Result   : Buses.Outcome;
      Receipts : Networks.Receipt_List;
   begin
      Fault_Plans.Draw (Plan, M.Start, Fault);
      Networks.Step (N, M, Fault, Result, Receipts);
      if Result.Ended = Buses.Broken then
         Fault_Plans.Note (Plan, Result.Struck);
      end if;
      Write_Down (Log, Result);
      for C in Node_Index loop
         if Clients (C).State = Bus_Clients.Joined then
            Publish (Clients (C), N, C, Result, Receipts (C), Fault);
         end if;
      end loop;
   end Carry;

   -------------
   -- Connect --
   -------------

   procedure Connect
     (Clients : in out Client_List; Clock : Nanoseconds; C : out Node_Index)
   is
   begin
      C := 1;
      while Clients (C).State /= Bus_Clients.Unconnected loop
         pragma Loop_Invariant
           (for all D in 1 .. C =>
              Clients (D).State /= Bus_Clients.Unconnected);
         C := C + 1;
      end loop;
      Bus_Clients.Welcome (Clients (C), Clock + Hello_Limit);
   end Connect;

   ------------
   -- Expire --
   ------------

   procedure Expire (Clients : in out Client_List; Clock : Nanoseconds) is
   begin
      for C in Node_Index loop
         if Clients (C).State = Bus_Clients.Greeting
           and then Clients (C).Limit <= Clock
         then
            Bus_Clients.End_With
              (Clients (C), Bus_Records.No_Hello_In_Time);
         end if;
         pragma Loop_Invariant
           (for all D in 1 .. C =>
              (if Clients (D).State = Bus_Clients.Greeting
               then Clock < Clients (D).Limit));
      end loop;
   end Expire;

   ----------------
   -- Disconnect --
   ----------------

   procedure Disconnect (S : in out Server; C : Node_Index) is
   begin
      Line_Events.Leave (S.Net, C);
      Bus_Clients.Forget (S.Clients (C));
   end Disconnect;

   ----------
   -- Take --
   ----------

   procedure Take
     (S     : in out Server;
      C     : Node_Index;
      Bytes : Bus_Records.Image;
      Now   : Nanoseconds)
   is
      R     : constant Bus_Records.Request := Bus_Records.Read (Bytes);
      Joins : Boolean;
   begin
      case S.Clients (C).State is
         when Bus_Clients.Greeting =>
            Bus_Clients.Greet (S.Clients (C), C, S.Profile, R, Now, Joins);
            if Joins then
               Line_Events.Join (S.Net, C);
               S.Net.Bus.Nodes (C).Restart :=
                 Bus_Clients.Restart_For (R, S.Profile);
            end if;
         when Bus_Clients.Joined   =>
            case R.Kind is
               when Bus_Records.Frame_Request    =>
                  Ask (S.Clients (C), S.Net, C, R, Now);
               when Bus_Records.Recovery_Request =>
                  Buses.Recover (S.Net.Bus, C, Now);
               when others                       =>
                  Bus_Clients.End_With
                    (S.Clients (C), Bus_Records.Malformed);
            end case;
         when others               =>
            null;
      end case;
   end Take;

   ---------
   -- Run --
   ---------

   procedure Run (S : in out Server; Horizon : Nanoseconds; Busy : out Boolean)
   is
      Moment : Networks.Moment;
   begin
      Busy := True;
      for Count in 1 .. Steps loop
         Moment := Networks.Next (S.Net);
         if Is_Due (S.Agenda, Horizon)
           and then
             (if Moment.Known
              then Is_Due (S.Agenda, Moment.Start)
              else not Is_Virtual (S))
         then
            Apply_Next (S.Net, S.Agenda);
         elsif Moment.Known
           and then Moment.Start <= Horizon
           and then Moment.Start <= Buses.Last_Start
         then
            Carry (S.Clients, S.Net, S.Plan, S.Log, Moment);
         else
            Busy := False;
            return;
         end if;
      end loop;
   end Run;

   ---------------
   -- Close_All --
   ---------------

   procedure Close_All (Clients : in out Client_List) is
   begin
      for To of Clients loop
         if To.State in Bus_Clients.Greeting | Bus_Clients.Joined then
            Bus_Clients.End_With (To, Bus_Records.Closing);
         end if;
      end loop;
   end Close_All;

   ----------------
   -- Next_Start --
   ----------------

   function Next_Start (S : Server) return Nanoseconds is
      Moment : constant Networks.Moment := Networks.Next (S.Net);
   begin
      return
        First
          (S.Agenda,
           (if Moment.Known then Moment.Start else Nanoseconds'Last));
   end Next_Start;

end Ravenchart.Can.Bus_Servers;
