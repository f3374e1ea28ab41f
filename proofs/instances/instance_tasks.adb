--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Health;
with Ravenchart.Liveness;
with Ravenchart.Queueing;
with Ravenchart.Timers;
with Ravenchart.Traces;

package body Instance_Tasks
  with
    SPARK_Mode,
    Refined_State =>
      (Periodic_State => (Port, Timers, Raised),
       Sporadic_State => (Last_Frame, Last_Stamp))
is
   use type Ravenchart.Queueing.Put_Status;
   use type Ravenchart.Queueing.Take_Status;
   package Any_Frames renames Ravenchart.Can.Any_Frames;

   use type Ravenchart.Can.Send_Status;
   use type Ravenchart.Nanoseconds;
   use type Instance_Store.Ports.Change;

   Port       : Instance_Store.Ports.Port;
   Timers     : Ravenchart.Timers.Timer_Array (1 .. 2);
   Raised     : Instance_Store.Events.List;
   Last_Frame : Ravenchart.Can.Any_Frames.Any_Frame;
   Last_Stamp : Ravenchart.Nanoseconds := 0;

   procedure Sense_Input
   with
     Global =>
       (In_Out => (Port, Raised,
                   Instance_Store.Rejecting_Queue.State,
                   Instance_Store.Board.State,
                   Instance_Store.Counters.State));
   --  The port handler.

   procedure Control_Output
   with
     Global =>
       (Input  => Instance_Store.Board.State,
        In_Out => (Timers, Raised,
                   Instance_Store.Dropping_Queue.State,
                   Instance_Store.Counters.State,
                   Instance_Bus.Controller.State,
                   Instance_Bus.Controller.Wake_Up));
   --  The region.

   -----------------
   -- Sense_Input --
   -----------------

   procedure Sense_Input is
      Item   : Instance_Store.Reading;
      Status : Ravenchart.Queueing.Take_Status;
      Change : Instance_Store.Ports.Change;
   begin
      Instance_Store.Rejecting_Queue.Take (Item, Status);
      Instance_Store.Ports.Handle
        (Port, Status = Ravenchart.Queueing.Taken, Item, 5, Change);
      case Change is
         when Instance_Store.Ports.Arrival =>
            Instance_Store.Board.Write (Port.Value);
            Instance_Store.Events.Append (Raised, Instance_Store.Start);
         when Instance_Store.Ports.Became_Stale =>
            Instance_Store.Counters.Record_Fault
              (Ravenchart.Health.Stale_Input);
         when Instance_Store.Ports.Nothing =>
            null;
      end case;
   end Sense_Input;

   --------------------
   -- Control_Output --
   --------------------

   procedure Control_Output is
      Due     : Natural;
      Reading : Instance_Store.Reading;
      Put     : Ravenchart.Queueing.Put_Status;
      Send    : Ravenchart.Can.Send_Status;
   begin
      Ravenchart.Timers.Tick (Timers);
      Ravenchart.Timers.Take_Due (Timers, Due);
      if Due = 0 then
         Ravenchart.Timers.Arm (Timers (1), 10);
         Ravenchart.Timers.Disarm (Timers (2));
      end if;
      for I in 1 .. Instance_Store.Events.Count (Raised) loop
         Instance_Store.Dropping_Queue.Put
           (Instance_Store.Events.Element (Raised, I), Put);
         if Put /= Ravenchart.Queueing.Queued then
            Instance_Store.Counters.Record_Fault
              (Ravenchart.Health.Queue_Overflow);
         end if;
      end loop;
      Instance_Store.Events.Clear (Raised);
      Instance_Store.Board.Read (Reading);
      Instance_Bus.Controller.Send
        (Any_Frames.To_Any
           (Ravenchart.Can.Data_Frame
              (Id      => 16#105#,
               Format  => Ravenchart.Can.Standard,
               Length  => 1,
               Payload => (if Reading.Valid then 1 else 0))),
         Send);
      if Send = Ravenchart.Can.Rejected_Full then
         Instance_Store.Counters.Record_Fault
           (Ravenchart.Health.Queue_Overflow);
      end if;
      Instance_Bus.Controller.Send
        (Any_Frames.To_Any
           (Ravenchart.Can.Fd_Frames.Fd_Data_Frame
              (Id     => 16#106#,
               Format => Ravenchart.Can.Standard,
               Length => 64,
               Words  => (others => (if Reading.Valid then 1 else 0)),
               Rate   => Ravenchart.Can.Fd_Frames.Switched_Rate)),
         Send);
      if Send = Ravenchart.Can.Rejected_Full then
         Instance_Store.Counters.Record_Fault
           (Ravenchart.Health.Queue_Overflow);
      end if;
   end Control_Output;

   -------------
   -- Run_Job --
   -------------

   procedure Run_Job (Activity : Job) is
   begin
      case Activity is
         when Sense =>
            Sense_Input;
         when Control =>
            Control_Output;
         when Report =>
            Instance_Store.Trace.Note
              (Ravenchart.Traces.Activity, 7, Job'Pos (Activity));
      end case;
   end Run_Job;

   -----------------
   -- Await_Frame --
   -----------------

   procedure Await_Frame is
   begin
      Instance_Bus.Controller.Wait_Frame (Last_Frame, Last_Stamp);
   end Await_Frame;

   -----------------
   -- Run_Service --
   -----------------

   procedure Run_Service (Activity : Service) is
      Put : Ravenchart.Queueing.Put_Status;
   begin
      case Activity is
         when Receive =>
            Instance_Store.Rejecting_Queue.Put
              ((Level => Ravenchart.Number (Any_Frames.Id (Last_Frame)),
                Valid => Last_Stamp > 0),
               Put);
            if Put = Ravenchart.Queueing.Rejected_Full then
               Instance_Store.Counters.Record_Fault
                 (Ravenchart.Health.Queue_Overflow);
            end if;
      end case;
   end Run_Service;

   ---------------
   -- Note_Miss --
   ---------------

   procedure Note_Miss is
   begin
      Instance_Store.Counters.Record_Fault
        (Ravenchart.Health.Deadline_Miss);
   end Note_Miss;

   ------------------
   -- Note_Overrun --
   ------------------

   procedure Note_Overrun (Activity : Job; Used : Ravenchart.Nanoseconds) is
      Budgets : constant array (Job) of Ravenchart.Nanoseconds :=
        (Sense => 100_000, Control => 500_000, Report => 1_000_000);
   begin
      if Used > Budgets (Activity) then
         Instance_Store.Counters.Record_Fault (Ravenchart.Health.Overrun);
      end if;
   end Note_Overrun;

   ----------
   -- Look --
   ----------

   procedure Look
     (Item      : Watched;
      Elapsed   : Ravenchart.Nanoseconds;
      Is_Silent : out Boolean)
   is
      Seen : Ravenchart.Liveness.Progress;
   begin
      case Item is
         when Watched_Cyclic =>
            Cyclic.Observe_Progress (Seen);
            Is_Silent := Ravenchart.Liveness.Is_Silent
              ((Offset => 1_000_000,
                Period => 10_000_000,
                Limit  => 15_000_000),
               Seen,
               Elapsed);
         when Watched_Served =>
            Served.Observe_Progress (Seen);
            Is_Silent := Ravenchart.Liveness.Is_Stuck
              (7_000_000, Seen, Elapsed);
      end case;
   end Look;

   ------------------
   -- Note_Silence --
   ------------------

   procedure Note_Silence (Item : Watched) is
   begin
      Instance_Store.Counters.Record_Fault (Ravenchart.Health.Silence);
      Ravenchart.Failures.Note_Silence
        (case Item is
            when Watched_Cyclic => "cyclic",
            when Watched_Served => "served");
   end Note_Silence;

end Instance_Tasks;
