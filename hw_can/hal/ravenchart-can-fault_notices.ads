--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The faults of fault confinement as notified to a node's model: a log that
--  the driver keeps of its controller, and the notices between two looks at
--  the log.
--
--  Guarantees   each entry into error-passive and bus-off is counted, and each
--               return to error-active after it; so no look misses a short
--               fault since the look before
--  Tasking      none: values
--  Timing       constant
--
--  ISO 11898-1 (2015), fault confinement. Stopped is not one of its states: a
--  controller without a bus has neither failed nor recovered.

package Ravenchart.Can.Fault_Notices
  with SPARK_Mode, Pure
is
   subtype Fault_State is Controller_State range Error_Passive .. Bus_Off;
   --  The states that are faults.

   type Fault_Log is record
      State           : Controller_State := Stopped;
      Disturbed       : Boolean := False;
      Passive_Entries : Event_Count := 0;
      Off_Entries     : Event_Count := 0;
      Returns         : Event_Count := 0;
   end record
   with
     Predicate =>
       (if State in Fault_State then Disturbed
        elsif State = Error_Active then not Disturbed);
   --  Disturbed: the controller has not been error-active since its last
   --  fault. The counts are those of entries into error-passive and bus-off,
   --  and of returns from them.

   type Notices is record
      Error_Passive : Boolean := False;
      Bus_Off       : Boolean := False;
      Recovered     : Boolean := False;
   end record;
   --  The notices to a model, in this order.

   function Between (Before, After : Fault_Log) return Notices
   is (Error_Passive =>
         After.Passive_Entries > Before.Passive_Entries
         or else (After.State = Can.Error_Passive
                  and then Before.State /= Can.Error_Passive),
       Bus_Off       =>
         After.Off_Entries > Before.Off_Entries
         or else (After.State = Can.Bus_Off
                  and then Before.State /= Can.Bus_Off),
       Recovered     =>
         After.State = Error_Active
         and then (Before.Disturbed
                   or else After.Returns > Before.Returns))
   with Global => null;
   --  The notices of all entries between two looks. The last of them is true
   --  at After: Recovered only where the controller is error-active.

   function Noted
     (Log : Fault_Log; Now : Controller_State) return Fault_Log
   is (State           => Now,
       Disturbed       =>
         (case Now is
            when Error_Passive | Bus_Off => True,
            when Error_Active            => False,
            when Stopped                 => Log.Disturbed),
       Passive_Entries =>
         (if Now = Error_Passive and then Log.State /= Error_Passive
          then Next (Log.Passive_Entries) else Log.Passive_Entries),
       Off_Entries     =>
         (if Now = Bus_Off and then Log.State /= Bus_Off
          then Next (Log.Off_Entries) else Log.Off_Entries),
       Returns         =>
         (if Now = Error_Active and then Log.Disturbed
          then Next (Log.Returns) else Log.Returns))
   with
     Global => null,
     Post   =>
       Noted'Result.State = Now
       and then Between (Log, Noted'Result) =
         Notices'
           (Error_Passive =>
              Now = Can.Error_Passive
              and then Log.State /= Can.Error_Passive,
            Bus_Off       =>
              Now = Can.Bus_Off and then Log.State /= Can.Bus_Off,
            Recovered     => Now = Error_Active and then Log.Disturbed);
   --  The log after the controller has entered this state.

   function Is_Later (Log, Seen : Fault_Log) return Boolean
   is (Log.Passive_Entries >= Seen.Passive_Entries
       and then Log.Off_Entries >= Seen.Off_Entries
       and then Log.Returns >= Seen.Returns
       and then
         (if Log.State = Error_Passive and then Seen.State /= Error_Passive
          then Log.Passive_Entries > Seen.Passive_Entries)
       and then
         (if Log.State = Bus_Off and then Seen.State /= Bus_Off
          then Log.Off_Entries > Seen.Off_Entries))
   with Ghost, Global => null;
   --  Log is a later state of Seen, while no count is at its last value.

   function Can_Count (Log : Fault_Log) return Boolean
   is (Log.Passive_Entries < Event_Count'Last
       and then Log.Off_Entries < Event_Count'Last
       and then Log.Returns < Event_Count'Last)
   with Ghost, Global => null;
   --  No count is at its last value, which takes 2**62 entries.

   procedure Lemma_No_Fault_Missed
     (Seen, Log : Fault_Log; Now : Controller_State)
   with
     Ghost,
     Global => null,
     Pre    => Is_Later (Log, Seen) and then Can_Count (Log),
     Post   =>
       Is_Later (Seen, Seen)
       and then Is_Later (Noted (Log, Now), Seen)
       and then
         (if Between (Seen, Log).Error_Passive
            or else Between (Log, Noted (Log, Now)).Error_Passive
          then Between (Seen, Noted (Log, Now)).Error_Passive)
       and then
         (if Between (Seen, Log).Bus_Off
            or else Between (Log, Noted (Log, Now)).Bus_Off
          then Between (Seen, Noted (Log, Now)).Bus_Off)
       and then
         (if Between (Log, Noted (Log, Now)).Recovered
          then Between (Seen, Noted (Log, Now)).Recovered);
   --  A notice of the log after a look remains until the next look, whatever
   --  is noted after it. By induction, no fault is missed.

   subtype Look_Count is Execution_Count range 1 .. Execution_Count'Last;
   --  The number of looks in bus-off before recovery is requested.

   procedure Count_Off
     (Left   : in out Look_Count;
      Found  : Notices;
      State  : Controller_State;
      Limit  : Look_Count;
      Is_Due : out Boolean)
   with
     Global => null,
     Post   =>
       (if State /= Can.Bus_Off or else Found.Bus_Off
        then Left = Limit and then not Is_Due
        elsif Left'Old = 1 then Left = Limit and then Is_Due
        else Left = Left'Old - 1 and then not Is_Due);
   --  One more look at a controller that recovers after a delay. Recovery is
   --  due Limit looks after the one that found bus-off, and after each Limit
   --  looks more.

end Ravenchart.Can.Fault_Notices;
