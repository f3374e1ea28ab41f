--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The statistics of one processor: releases, misses, the last response and
--  worst times.
--
--  Guarantees   contract of Note: worst values only grow; one Read sees one
--               instant
--  Tasking      any task up to Ceiling
--  Timing       linear in the number of activities, never blocks
--  Analysis     one shared object, ceiling Ceiling

with System;
with Ravenchart.Liveness;

generic
   type Activity_Id is (<>);
   Ceiling : System.Any_Priority;
   --  At least the priority of every caller.
package Ravenchart.Monitors
  with
    SPARK_Mode,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   type Execution_Times is array (Activity_Id) of Nanoseconds;
   --  Processor time of each activity; 0 for one that did not run.

   type Statistics is record
      Releases        : Event_Count := 0;
      Misses          : Event_Count := 0;
      Last_Response   : Nanoseconds := 0;
      Worst_Response  : Nanoseconds := 0;
      Worst_Execution : Execution_Times := (others => 0);
   end record;
   --  Misses counts the releases that completed after their deadline.
   --  Last_Response is that of the release that completed last.

   procedure Note
     (S        : in out Statistics;
      Response : Nanoseconds;
      Missed   : Boolean;
      Times    : Execution_Times)
   with
     Global => null,
     Post   =>
       S.Releases = Next (S.Releases'Old)
       and then S.Misses = (if Missed then Next (S.Misses'Old)
                            else S.Misses'Old)
       and then S.Last_Response = Response
       and then S.Worst_Response
                = Nanoseconds'Max (S.Worst_Response'Old, Response)
       and then (for all A in Activity_Id =>
                   S.Worst_Execution (A)
                   = Nanoseconds'Max
                       (S.Worst_Execution'Old (A), Times (A)));
   --  One more release has completed.

   procedure Record_Begin (Due : Nanoseconds)
   with Global => (In_Out => State);
   --  Note that a release has begun that was due at Due from the start.
   --  Sporadic processors call it, since their releases are not known in
   --  advance.

   procedure Record_Release
     (Response : Nanoseconds; Missed : Boolean; Times : Execution_Times)
   with Global => (In_Out => State);
   --  Note that one more release has completed.

   procedure Read (S : out Statistics)
   with Global => (Input => State);
   --  Copy the statistics up to now.

   procedure Read_Progress (Seen : out Liveness.Progress)
   with Global => (Input => State);
   --  Copy the progress of the processor, in constant time.

end Ravenchart.Monitors;
