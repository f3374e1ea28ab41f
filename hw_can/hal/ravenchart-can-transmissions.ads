--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Transmission modes of messages besides the periodic one: they decide
--  whether a frame goes at the end of an execution of the row that sends it.
--
--  Guarantees   a frame is due only if at least Minimum executions have begun
--               since that of the last one. In mode On_Change it is due only
--               if it differs from the last one. In mode Mixed it is also due
--               once Period executions have begun, at the latest
--  Tasking      none: the task of the row owns the Sender
--  Timing       linear in the length of the frame
--
--  AUTOSAR CP SWS_COM: transmission modes DIRECT (On_Change: triggered on
--  change; On_Event: triggered) and MIXED, and the minimum delay time. Time
--  counts in executions of the row, which begin once in every period of it.

with Ravenchart.Can.Any_Frames;

package Ravenchart.Can.Transmissions
  with SPARK_Mode, Pure
is
   use type Any_Frames.Any_Frame;

   type Transmission_Mode is (On_Change, On_Event, Mixed);
   --  On_Change: a value that differs from the last one sent. On_Event: each
   --  value given, the newest of those between two frames. Mixed: a value
   --  that differs, and the last one again after the period.

   subtype Distance is Execution_Count range 1 .. Execution_Count'Last;
   --  Executions from one frame to another.

   type Setting is record
      Mode    : Transmission_Mode := On_Change;
      Minimum : Distance          := 1;
      Period  : Distance          := Distance'Last;
   end record
   with Predicate => Minimum <= Period;
   --  Minimum: the minimum delay time. Period belongs to mode Mixed.

   type Sender is record
      Has_Value : Boolean := False;
      Is_Asked  : Boolean := False;
      Has_Sent  : Boolean := False;
      Last      : Any_Frames.Any_Frame;
      Since     : Execution_Count := 0;
   end record;
   --  Has_Value: the row has given a value. Is_Asked: it has given one since
   --  the last frame. Last: the last frame, if Has_Sent. Since: executions
   --  that have ended since then.

   function Keeps_Distance (State : Sender; S : Setting) return Boolean
   is (not State.Has_Sent or else State.Since >= S.Minimum)
   with Global => null;
   --  Is the minimum delay time over?

   function Is_Wanted
     (State : Sender; S : Setting; F : Any_Frames.Any_Frame) return Boolean
   is (not State.Has_Sent
       or else
         (case S.Mode is
            when On_Change => F /= State.Last,
            when On_Event  => State.Is_Asked,
            when Mixed     =>
              F /= State.Last or else State.Since >= S.Period))
   with Global => null;
   --  Does the mode require to send F, which carries the newest value?

   function Is_Due
     (State : Sender; S : Setting; F : Any_Frames.Any_Frame) return Boolean
   is (State.Has_Value
       and then Keeps_Distance (State, S)
       and then Is_Wanted (State, S, F))
   with
     Global => null,
     Post   =>
       (if S.Mode = Mixed
          and then State.Has_Value
          and then State.Since >= S.Period
        then Is_Due'Result);
   --  Is F to be sent at the end of this execution?

   procedure Give (State : in out Sender)
   with
     Global => null,
     Post   =>
       State =
         (Has_Value => True,
          Is_Asked  => True,
          Has_Sent  => State'Old.Has_Sent,
          Last      => State'Old.Last,
          Since     => State'Old.Since);
   --  The row gives a value.

   procedure Count (State : in out Sender)
   with
     Global => null,
     Post   =>
       State =
         (Has_Value => State'Old.Has_Value,
          Is_Asked  => State'Old.Is_Asked,
          Has_Sent  => State'Old.Has_Sent,
          Last      => State'Old.Last,
          Since     =>
            (if State'Old.Since = Execution_Count'Last
             then State'Old.Since
             else State'Old.Since + 1));
   --  An execution of the row has ended.

   procedure Record_Sent (State : in out Sender; F : Any_Frames.Any_Frame)
   with
     Global => null,
     Post   => State = (State'Old.Has_Value, False, True, F, 0);
   --  The controller has taken F.

end Ravenchart.Can.Transmissions;
