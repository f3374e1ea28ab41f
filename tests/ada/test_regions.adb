--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The pure parts of regions: ports, timers, schedule slots, event lists,
--  deferral, and the list of the transitions of a step.

with Facts;
with Instance_Store;
with Objects;
with Ravenchart.Schedules;
with Ravenchart.Timers;

procedure Test_Regions is
   package Proved renames Instance_Store;

   use type Instance_Store.Signal;
   use type Instance_Store.Way;
   use type Objects.Ports.Change;
   use type Objects.Signal;
   use type Ravenchart.Execution_Count;
   use type Ravenchart.Freshness;
   use type Ravenchart.Timers.Remaining_Count;

   procedure Check_Ports;

   procedure Check_Timers;

   procedure Check_Slots;

   procedure Check_Events;

   procedure Check_Deferral;

   procedure Check_Firings;

   -----------------
   -- Check_Ports --
   -----------------

   procedure Check_Ports is
      Port    : Objects.Ports.Port;
      Outcome : Objects.Ports.Change;
      Right   : Boolean := True;
   begin
      for I in 1 .. 5 loop
         Objects.Ports.Handle (Port, False, 0, 2, Outcome);
         Right := Right
           and then Outcome = Objects.Ports.Nothing
           and then Port.State = Ravenchart.Never_Received
           and then Port.Value = 7;
      end loop;
      Facts.Check ("a port without arrival is never stale", Right);
      Objects.Ports.Handle (Port, True, 11, 2, Outcome);
      Facts.Check
        ("an arrival makes a port fresh",
         Outcome = Objects.Ports.Arrival
         and then Port.State = Ravenchart.Fresh
         and then Port.Value = 11
         and then Port.Age = 0);
      Objects.Ports.Handle (Port, False, 0, 2, Outcome);
      Objects.Ports.Handle (Port, False, 0, 2, Outcome);
      Facts.Check
        ("a port is fresh up to its limit",
         Outcome = Objects.Ports.Nothing
         and then Port.State = Ravenchart.Fresh
         and then Port.Age = 2);
      Objects.Ports.Handle (Port, False, 0, 2, Outcome);
      Facts.Check
        ("a port is stale beyond its limit and keeps its value",
         Outcome = Objects.Ports.Became_Stale
         and then Port.State = Ravenchart.Stale
         and then Port.Value = 11);
      Objects.Ports.Handle (Port, False, 0, 2, Outcome);
      Facts.Check
        ("a port becomes stale once", Outcome = Objects.Ports.Nothing);
      Port := (1, Ravenchart.Fresh, Ravenchart.Execution_Count'Last);
      Objects.Ports.Handle
        (Port, False, 0, Objects.Ports.Never_Stale, Outcome);
      Facts.Check
        ("the last limit means never stale",
         Outcome = Objects.Ports.Nothing
         and then Port.State = Ravenchart.Fresh);
   end Check_Ports;

   ------------------
   -- Check_Timers --
   ------------------

   procedure Check_Timers is
      Timers : Ravenchart.Timers.Timer_Array (1 .. 4);
      None   : Ravenchart.Timers.Timer_Array (1 .. 0);
      Due    : Natural;
   begin
      Ravenchart.Timers.Take_Due (None, Due);
      Facts.Check ("no timers, none due", Due = 0);
      Ravenchart.Timers.Take_Due (Timers, Due);
      Facts.Check ("a timer is not armed at first", Due = 0);
      Ravenchart.Timers.Arm (Timers (1), 3);
      Ravenchart.Timers.Arm (Timers (2), 2);
      Ravenchart.Timers.Arm (Timers (3), 1);
      Ravenchart.Timers.Arm (Timers (4), 2);
      Ravenchart.Timers.Tick (Timers);
      Ravenchart.Timers.Take_Due (Timers, Due);
      Facts.Check ("a timer of 1 is due in the next execution", Due = 3);
      Ravenchart.Timers.Take_Due (Timers, Due);
      Facts.Check ("a timer is taken once", Due = 0);
      Ravenchart.Timers.Tick (Timers);
      Ravenchart.Timers.Tick (Timers);
      Ravenchart.Timers.Take_Due (Timers, Due);
      Facts.Check ("the earliest expiry comes first", Due = 2);
      Ravenchart.Timers.Take_Due (Timers, Due);
      Facts.Check ("model order breaks a tie", Due = 4);
      Ravenchart.Timers.Disarm (Timers (1));
      Ravenchart.Timers.Take_Due (Timers, Due);
      Facts.Check ("a disarmed timer is not due", Due = 0);
      Timers (1) := (True, Ravenchart.Timers.Remaining_Count'First, 0);
      Ravenchart.Timers.Tick (Timers);
      Facts.Check
        ("a timer stops counting at the end of its range",
         Timers (1).Remaining = Ravenchart.Timers.Remaining_Count'First);
      Ravenchart.Timers.Arm (Timers (1), 0);
      Ravenchart.Timers.Take_Due (Timers, Due);
      Facts.Check ("a timer of 0 is due at once", Due = 1);
      Ravenchart.Timers.Arm (Timers (1), 1, Period => 2);
      for I in 1 .. 4 loop
         Ravenchart.Timers.Tick (Timers);
      end loop;
      Ravenchart.Timers.Take_Due (Timers, Due);
      Facts.Check
        ("a repeating timer starts again without drift",
         Due = 1 and then Timers (1).Armed and then Timers (1).Remaining = -1);
   end Check_Timers;

   -----------------
   -- Check_Slots --
   -----------------

   procedure Check_Slots is
      Third : constant Ravenchart.Schedules.Slot := (3, 1);
      Count : Natural := 0;
   begin
      for Release in 0 .. 8 loop
         if Ravenchart.Schedules.Runs_In (Third, Release) then
            Count := Count + 1;
         end if;
      end loop;
      Facts.Check ("a slot runs once in Divisor releases", Count = 3);
      Facts.Check
        ("a slot runs in its phase",
         Ravenchart.Schedules.Runs_In (Third, 4)
         and then not Ravenchart.Schedules.Runs_In (Third, 3));
      Facts.Check
        ("a slot fits a multiple of its divisor",
         Ravenchart.Schedules.Fits (Third, 6)
         and then not Ravenchart.Schedules.Fits (Third, 4)
         and then not Ravenchart.Schedules.Fits ((3, 3), 6));
   end Check_Slots;

   ------------------
   -- Check_Events --
   ------------------

   procedure Check_Events is
      List : Objects.Events.List;
   begin
      Facts.Check ("a new list is empty", Objects.Events.Count (List) = 0);
      Objects.Events.Append (List, Objects.Reset);
      Objects.Events.Append (List, Objects.Start);
      Objects.Events.Append (List, Objects.Stop);
      Objects.Events.Append (List, Objects.Reset);
      Facts.Check
        ("a full list ignores an event and keeps its order",
         Objects.Events.Count (List) = 3
         and then Objects.Events.Element (List, 1) = Objects.Reset
         and then Objects.Events.Element (List, 2) = Objects.Start
         and then Objects.Events.Element (List, 3) = Objects.Stop);
      Objects.Events.Clear (List);
      Facts.Check
        ("a cleared list is empty", Objects.Events.Count (List) = 0);
   end Check_Events;

   --------------------
   -- Check_Deferral --
   --------------------

   procedure Check_Deferral is

      procedure Defer (Event : Proved.Signal);

      Store : Proved.Deferred.Store;
      Item  : Proved.Signal;
      Taken : Boolean;

      -----------
      -- Defer --
      -----------

      procedure Defer (Event : Proved.Signal) is
      begin
         Proved.Deferred.Change
           (Store, True, Event, Proved.Nothing_Left, Proved.Busy);
      end Defer;

   begin
      Defer (Proved.Start);
      Defer (Proved.Stop);
      Proved.Deferred.Take_Due (Store, Proved.Busy, Item, Taken);
      Facts.Check ("what is deferred is not due", not Taken);
      Defer (Proved.Reset);
      Proved.Deferred.Take_Due (Store, Proved.Busy, Item, Taken);
      Facts.Check
        ("what no active state defers is due before older events",
         Taken and then Item = Proved.Reset);
      Proved.Deferred.Change
        (Store, False, Proved.Reset, Proved.All_Left, Proved.Busy);
      Defer (Proved.Stop);
      Proved.Deferred.Take_Due (Store, Proved.Busy, Item, Taken);
      Facts.Check
        ("an exit frees what was deferred before it",
         Taken and then Item = Proved.Stop);
      Proved.Deferred.Take_Due (Store, Proved.Busy, Item, Taken);
      Facts.Check ("and nothing that was deferred later", not Taken);
      Proved.Deferred.Take_Due (Store, Proved.Idle, Item, Taken);
      Facts.Check
        ("the oldest one is due first elsewhere",
         Taken and then Item = Proved.Start);
      Facts.Check ("nothing was lost", not Store.Lost);
      for I in 1 .. 3 loop
         Defer (Proved.Start);
      end loop;
      Facts.Check ("an event too many is lost", Store.Lost);
   end Check_Deferral;

   -------------------
   -- Check_Firings --
   -------------------

   procedure Check_Firings is
      Fired : Proved.Firings.List;
   begin
      Facts.Check
        ("at first nothing has fired",
         Fired.Count = 0
         and then not Proved.Firings.Has (Fired, Proved.None));
      Proved.Firings.Add (Fired, Proved.Second_Way);
      Proved.Firings.Add (Fired, Proved.Segment);
      Facts.Check
        ("what fires is listed in its order",
         Fired.Count = 2
         and then Fired.Items (1) = Proved.Second_Way
         and then Fired.Items (2) = Proved.Segment);
      Facts.Check
        ("a list has what has fired, and nothing else",
         Proved.Firings.Has (Fired, Proved.Segment)
         and then not Proved.Firings.Has (Fired, Proved.First_Way));
   end Check_Firings;

begin
   Check_Ports;
   Check_Timers;
   Check_Slots;
   Check_Events;
   Check_Deferral;
   Check_Firings;
   Facts.Finish;
end Test_Regions;
