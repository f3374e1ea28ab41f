with Interfaces;
with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Buses;
with Ravenchart.Can.Error_Frames;

package body Ravenchart.Can.Bus_Servers
  with SPARK_Mode
is
   use type Bus_Frames.Frame_Family;
   use type Buses.Ending;
   use type Error_Frames.Error_Kind;
   use type Interfaces.Unsigned_32;

   procedure Say
     (To : in out Client; Bytes : Bus_Records.Image; Due : Nanoseconds)
   with Global => null;
   --  Queue a record. Who is too far behind is given up.

   function Later (A, B : Nanoseconds) return Nanoseconds
   is (if A < B then B else A)
   with Global => null;
   --  The later of two.

   function Is_Told (S : Server; C : Node_Index) return Boolean
   is (Fault_Confinement.Transmit_Errors (S.Clients (C).Told)
       = Fault_Confinement.Transmit_Errors (S.Net.Bus.Nodes (C).Confinement)
       and then
         Fault_Confinement.Receive_Errors (S.Clients (C).Told)
         = Fault_Confinement.Receive_Errors
             (S.Net.Bus.Nodes (C).Confinement))
   with Global => null;
   --  Does C know its counters as they are?

   procedure End_With (To : in out Client; Why : Bus_Records.Status)
   with Global => null;
   --  Say why, and close.

   procedure Greet
     (S : in out Server; C : Node_Index; R : Bus_Records.Request;
      Now : Nanoseconds)
   with
     Global => null,
     Pre    => Is_Sound (S),
     Post   => Is_Sound (S);
   --  The first thing that C has said.

   procedure Ask
     (S : in out Server; C : Node_Index; R : Bus_Records.Request;
      Now : Nanoseconds)
   with
     Global => null,
     Pre    => Is_Sound (S),
     Post   => Is_Sound (S);
   --  C asks for a frame to be sent.

   procedure Tell_State
     (S : in out Server; C : Node_Index; Now : Nanoseconds)
   with
     Global => null,
     Pre    => Is_Sound (S),
     Post   => Is_Sound (S);
   --  Tell C its counters, where they have changed; when it is bus-off, what
   --  it had asked for is refused.

   procedure Publish
     (S        : in out Server;
      C        : Node_Index;
      Result   : Buses.Outcome;
      Receipt  : Networks.Receipt;
      Fault    : Bus_Faults.Fault)
   with
     Global => null,
     Pre    => Is_Sound (S),
     Post   => Is_Sound (S);
   --  What C is told of what happened on the bus.

   ---------
   -- Say --
   ---------

   procedure Say
     (To : in out Client; Bytes : Bus_Records.Image; Due : Nanoseconds)
   is
      Place : Natural;
   begin
      if To.Count = Depth then
         To.Count := 0;
         To.State := Given_Up;
      elsif To.State in Greeting | Joined then
         Place := To.First + To.Count;
         To.Queue (if Place > Depth then Place - Depth else Place) :=
           (Bytes => Bytes, Due => Due);
         To.Count := To.Count + 1;
      end if;
   end Say;

   --------------
   -- End_With --
   --------------

   procedure End_With (To : in out Client; Why : Bus_Records.Status) is
   begin
      Say (To, Bus_Records.Refusal (0, Why), To.Last);
      if To.State /= Given_Up then
         To.State := Ending;
      end if;
   end End_With;

   -------------
   -- Connect --
   -------------

   procedure Connect (S : in out Server; C : out Node_Index) is
   begin
      C := 1;
      while S.Clients (C).State /= Unconnected loop
         pragma Loop_Invariant
           (for all D in 1 .. C => S.Clients (D).State /= Unconnected);
         C := C + 1;
      end loop;
      S.Clients (C).State := Greeting;
      S.Clients (C).Last  := 0;
      S.Clients (C).Count := 0;
   end Connect;

   ----------------
   -- Disconnect --
   ----------------

   procedure Disconnect (S : in out Server; C : Node_Index) is
   begin
      Line_Events.Leave (S.Net, C);
      S.Clients (C).State := Unconnected;
      S.Clients (C).Count := 0;
   end Disconnect;

   -----------
   -- Greet --
   -----------

   procedure Greet
     (S : in out Server; C : Node_Index; R : Bus_Records.Request;
      Now : Nanoseconds)
   is
      To : Client renames S.Clients (C);
   begin
      case R.Kind is
         when Bus_Records.Hello         =>
            if C > Most_Nodes then
               End_With (To, Bus_Records.No_Room);
            elsif (R.Nominal /= 0 and then R.Nominal /= S.Speed.Nominal)
              or else (R.Data /= 0 and then R.Data /= S.Speed.Data)
            then
               End_With (To, Bus_Records.Wrong_Bit_Rate);
            else
               Line_Events.Join (S.Net, C);
               To.State    := Joined;
               To.Takes_Fd := R.Takes_Fd and then S.Speed.Data > 0;
               To.Told     := S.Net.Bus.Nodes (C).Confinement;
               To.Last     := Now;
               Say
                 (To,
                  Bus_Records.Welcome
                    (S.Name (1 .. S.Length), S.Speed.Data > 0,
                     S.Speed.Nominal, S.Speed.Data, S.Began, Now, C),
                  Now);
               Say (To, Bus_Records.State_Record (To.Told, Now), Now);
            end if;
         when Bus_Records.Wrong_Version =>
            End_With (To, Bus_Records.Version_Is_Wrong);
         when others                    =>
            End_With (To, Bus_Records.Malformed);
      end case;
   end Greet;

   ---------
   -- Ask --
   ---------

   procedure Ask
     (S : in out Server; C : Node_Index; R : Bus_Records.Request;
      Now : Nanoseconds)
   is
      To     : Client renames S.Clients (C);
      Status : Send_Status;
   begin
      for I in 1 .. Networks.Waiting (S.Net, C) loop
         if S.Net.Buffers (C).Slots (I).Tag = R.Number then
            End_With (To, Bus_Records.Malformed);
            return;
         end if;
      end loop;
      if R.Frame.Family = Bus_Frames.Flexible and then not To.Takes_Fd then
         Say
           (To, Bus_Records.Refusal (R.Number, Bus_Records.Not_Supported),
            To.Last);
      elsif not Takes_Part (S.Net.Bus.Nodes (C)) then
         Say
           (To, Bus_Records.Refusal (R.Number, Bus_Records.Is_Bus_Off),
            To.Last);
      else
         Networks.Submit
           (S.Net, C, (Frame => R.Frame, Tag => R.Number, Since => Now),
            Status);
         if Status = Rejected_Full then
            Say
              (To, Bus_Records.Refusal (R.Number, Bus_Records.No_Room),
               To.Last);
         end if;
      end if;
   end Ask;

   ----------
   -- Take --
   ----------

   procedure Take
     (S     : in out Server;
      C     : Node_Index;
      Bytes : Bus_Records.Image;
      Now   : Nanoseconds)
   is
      R : constant Bus_Records.Request := Bus_Records.Read (Bytes);
   begin
      case S.Clients (C).State is
         when Greeting                        =>
            Greet (S, C, R, Now);
         when Joined                          =>
            case R.Kind is
               when Bus_Records.Frame_Request    =>
                  Ask (S, C, R, Now);
               when Bus_Records.Recovery_Request =>
                  S.Net.Bus.Nodes (C).Way_Back := Recovers;
               when others                       =>
                  End_With (S.Clients (C), Bus_Records.Malformed);
            end case;
         when Unconnected | Ending | Given_Up =>
            null;
      end case;
   end Take;

   ----------------
   -- Tell_State --
   ----------------

   procedure Tell_State
     (S : in out Server; C : Node_Index; Now : Nanoseconds)
   is
      To : Client renames S.Clients (C);
   begin
      if not Is_Told (S, C) then
         To.Told := S.Net.Bus.Nodes (C).Confinement;
         Say (To, Bus_Records.State_Record (To.Told, Now), Now);
         if Fault_Confinement.State (To.Told) = Bus_Off then
            for I in 1 .. Networks.Waiting (S.Net, C) loop
               Say
                 (To,
                  Bus_Records.Refusal
                    (S.Net.Buffers (C).Slots (I).Tag,
                     Bus_Records.Is_Bus_Off),
                  Now);
            end loop;
            Networks.Withdraw (S.Net, C);
         end if;
      end if;
   end Tell_State;

   -------------
   -- Publish --
   -------------

   procedure Publish
     (S        : in out Server;
      C        : Node_Index;
      Result   : Buses.Outcome;
      Receipt  : Networks.Receipt;
      Fault    : Bus_Faults.Fault)
   is
      To    : Client renames S.Clients (C);
      Late  : constant Nanoseconds :=
        Bus_Faults.Lateness (Fault, Positive (C));
      Ended : constant Nanoseconds :=
        Later
          (To.Last,
           (if Result.Heard (C)
              and then Result.Finish <= Nanoseconds'Last - Late
            then Result.Finish + Late
            else Result.Finish));
      Frame : constant Bus_Frames.Bus_Frame :=
        Bus_Faults.As_Heard (Fault, Positive (C), Result.Frame);
   begin
      if Result.Sent (C) then
         To.Last := Ended;
         if Receipt.Tag > 0 then
            Say (To, Bus_Records.Confirmation (Receipt.Tag, Ended), Ended);
         end if;
      elsif Result.Heard (C)
        and then
          (Frame.Family /= Bus_Frames.Flexible or else To.Takes_Fd)
      then
         To.Last := Ended;
         for I in 1 .. Bus_Faults.Copies_For (Fault, Positive (C)) loop
            Say (To, Bus_Records.Frame_Record (Frame, Ended), Ended);
         end loop;
      end if;
      if not Is_Told (S, C) then
         To.Last := Ended;
         if Result.Ended = Buses.Broken
           and then S.Net.Bus.Nodes (C).Segment
             = S.Net.Bus.Nodes (Result.Winner).Segment
         then
            Say
              (To,
               (if Result.Error.Kind = Error_Frames.Acknowledgement_Error
                then Bus_Records.Error_Report (16#20#, 0, Ended)
                else Bus_Records.Error_Report (16#08#, 16#1_0000#, Ended)),
               Ended);
         end if;
         Tell_State (S, C, Ended);
      end if;
   end Publish;

   ---------
   -- Run --
   ---------

   procedure Run (S : in out Server; Horizon : Nanoseconds; Busy : out Boolean)
   is
      Moment   : Networks.Moment;
      Fault    : Bus_Faults.Fault;
      Result   : Buses.Outcome;
      Receipts : Networks.Receipt_List;
   begin
      Busy := True;
      for Count in 1 .. Steps loop
         pragma Loop_Invariant (Is_Sound (S));
         Moment := Networks.Next (S.Net);
         if S.Next <= S.Count
           and then
             (if Moment.Known
              then S.Events (S.Next).Start <= Moment.Start
              else not Is_Virtual (S))
           and then S.Events (S.Next).Start <= Horizon
         then
            Line_Events.Apply (S.Net, S.Events (S.Next));
            S.Next := S.Next + 1;
         elsif Moment.Known
           and then Moment.Start <= Horizon
           and then Moment.Start <= Buses.Last_Start
         then
            Fault_Plans.Draw (S.Plan, Moment.Start, Fault);
            Networks.Step (S.Net, Moment, Fault, Result, Receipts);
            if Result.Ended = Buses.Broken then
               Fault_Plans.Note (S.Plan, Result.Struck);
            end if;
            for C in Node_Index loop
               pragma Loop_Invariant (Is_Sound (S));
               if S.Clients (C).State = Joined then
                  Publish (S, C, Result, Receipts (C), Fault);
               end if;
            end loop;
         else
            Busy := False;
            return;
         end if;
      end loop;
   end Run;

   ---------------
   -- Close_All --
   ---------------

   procedure Close_All (S : in out Server) is
   begin
      for C in Node_Index loop
         pragma Loop_Invariant (Is_Sound (S));
         if S.Clients (C).State in Greeting | Joined then
            End_With (S.Clients (C), Bus_Records.Closing);
         end if;
      end loop;
   end Close_All;

   ---------------
   -- Hand_Over --
   ---------------

   procedure Hand_Over
     (S : in out Server; C : Node_Index; Bytes : out Bus_Records.Image)
   is
      From : Client renames S.Clients (C);
   begin
      Bytes := From.Queue (From.First).Bytes;
      From.First := (if From.First = Depth then 1 else From.First + 1);
      From.Count := From.Count - 1;
   end Hand_Over;

   ----------------
   -- Next_Start --
   ----------------

   function Next_Start (S : Server) return Nanoseconds is
      Moment : constant Networks.Moment := Networks.Next (S.Net);
      Begun  : constant Nanoseconds :=
        (if Moment.Known then Moment.Start else Nanoseconds'Last);
   begin
      return
        (if S.Next in 1 .. S.Count and then S.Events (S.Next).Start < Begun
         then S.Events (S.Next).Start
         else Begun);
   end Next_Start;

end Ravenchart.Can.Bus_Servers;
