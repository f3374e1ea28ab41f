--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Bus_Clients
  with SPARK_Mode
is
   procedure Say
     (To : in out Client; Bytes : Bus_Records.Image; Due : Nanoseconds)
   with
     Global => null,
     Post   =>
       To.State in To.State'Old | Given_Up and then To.Last = To.Last'Old;
   --  Queue a record. A client that is too far behind is given up.

   ---------
   -- Say --
   ---------

   procedure Say
     (To : in out Client; Bytes : Bus_Records.Image; Due : Nanoseconds) is
   begin
      if To.Queue.Count = Bus_Queues.Depth then
         Bus_Queues.Clear (To.Queue);
         To.State := Given_Up;
      elsif To.State in Greeting | Joined then
         Bus_Queues.Put (To.Queue, (Bytes => Bytes, Due => Due));
      end if;
   end Say;

   ----------------
   -- Time_Heard --
   ----------------

   function Time_Heard
     (To     : Client;
      C      : Node_Index;
      Result : Buses.Outcome;
      Fault  : Bus_Faults.Fault) return Nanoseconds
   is
      Late  : constant Nanoseconds :=
        Bus_Faults.Lateness (Fault, Positive (C));
      Ended : constant Nanoseconds :=
        (if Result.Heard (C)
           and then Result.Finish <= Nanoseconds'Last - Late
         then Result.Finish + Late
         else Result.Finish);
   begin
      return (if To.Last < Ended then Ended else To.Last);
   end Time_Heard;

   -------------
   -- Welcome --
   -------------

   procedure Welcome (To : in out Client; Limit : Nanoseconds) is
   begin
      To.State := Greeting;
      To.Last  := 0;
      To.Limit := Limit;
      Bus_Queues.Clear (To.Queue);
   end Welcome;

   ------------
   -- Forget --
   ------------

   procedure Forget (To : in out Client) is
   begin
      To.State := Unconnected;
      Bus_Queues.Clear (To.Queue);
   end Forget;

   --------------
   -- End_With --
   --------------

   procedure End_With (To : in out Client; Why : Bus_Records.Status) is
   begin
      Refuse (To, 0, Why);
      if To.State /= Given_Up then
         To.State := Ending;
      end if;
   end End_With;

   -----------
   -- Greet --
   -----------

   procedure Greet
     (To    : in out Client;
      C     : Node_Index;
      P     : Profile;
      R     : Bus_Records.Request;
      Now   : Nanoseconds;
      Joins : out Boolean)
   is
      Fresh : Fault_Confinement.Node;
   begin
      Joins := False;
      case R.Kind is
         when Bus_Records.Hello         =>
            if C > Most_Nodes then
               End_With (To, Bus_Records.No_Room);
            elsif not Suits (R, P) then
               End_With (To, Bus_Records.Wrong_Bit_Rate);
            else
               Joins       := True;
               To.State    := Joined;
               To.Takes_Fd := R.Takes_Fd and then P.Data > 0;
               To.Last     := Now;
               Say
                 (To,
                  Bus_Records.Welcome
                    (Bus_Names.Text (P.Name), P.Data > 0, P.Nominal, P.Data,
                     P.Began, Now, Positive (C)),
                  Now);
               Tell_State (To, Fresh);
            end if;
         when Bus_Records.Wrong_Version =>
            End_With (To, Bus_Records.Version_Is_Wrong);
         when others                    =>
            End_With (To, Bus_Records.Malformed);
      end case;
   end Greet;

   ------------
   -- Refuse --
   ------------

   procedure Refuse
     (To     : in out Client;
      Number : Interfaces.Unsigned_32;
      Why    : Bus_Records.Status) is
   begin
      Say (To, Bus_Records.Refusal (Number, Why), To.Last);
   end Refuse;

   ----------------
   -- Refuse_All --
   ----------------

   procedure Refuse_All
     (To : in out Client; B : Transmit_Buffers.Buffer) is
   begin
      for I in 1 .. Transmit_Buffers.Count (B) loop
         pragma Loop_Invariant (To.Last = To.Last'Loop_Entry);
         Refuse
           (To, Transmit_Buffers.Item (B, I).Tag, Bus_Records.Is_Bus_Off);
      end loop;
   end Refuse_All;

   ----------------
   -- Tell_Frame --
   ----------------

   procedure Tell_Frame
     (To     : in out Client;
      C      : Node_Index;
      Result : Buses.Outcome;
      Tag    : Interfaces.Unsigned_32;
      Fault  : Bus_Faults.Fault)
   is
      Ended : constant Nanoseconds := Time_Heard (To, C, Result, Fault);
      Frame : constant Bus_Frames.Bus_Frame :=
        Bus_Faults.As_Heard (Fault, Positive (C), Result.Frame);
   begin
      if Result.Sent (C) then
         To.Last := Ended;
         if Tag > 0 then
            Say (To, Bus_Records.Confirmation (Tag, Ended), Ended);
         end if;
      elsif Result.Heard (C)
        and then
          (Frame.Family /= Bus_Frames.Flexible or else To.Takes_Fd)
      then
         To.Last := Ended;
         for I in 1 .. Bus_Faults.Copies_For (Fault, Positive (C)) loop
            pragma Loop_Invariant (To.Last = Ended);
            Say (To, Bus_Records.Frame_Record (Frame, Ended), Ended);
         end loop;
      end if;
   end Tell_Frame;

   ----------------
   -- Tell_Error --
   ----------------

   procedure Tell_Error
     (To : in out Client; Kind : Error_Frames.Error_Kind) is
   begin
      Say (To, Report (Kind, To.Last), To.Last);
   end Tell_Error;

   ----------------
   -- Tell_State --
   ----------------

   procedure Tell_State
     (To : in out Client; Node : Fault_Confinement.Node) is
   begin
      To.Told := Node;
      Say (To, Bus_Records.State_Record (Node, To.Last), To.Last);
   end Tell_State;

   ---------------
   -- Hand_Over --
   ---------------

   procedure Hand_Over
     (To : in out Client; Bytes : out Bus_Records.Image) is
   begin
      Bytes := Bus_Queues.Item (To.Queue, 1).Bytes;
      Bus_Queues.Drop_Head (To.Queue);
   end Hand_Over;

end Ravenchart.Can.Bus_Clients;
