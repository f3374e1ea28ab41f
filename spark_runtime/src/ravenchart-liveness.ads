--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Decides whether a processor is silent: pure functions of its completed
--  releases and of the time, for its supervisor.
--
--  Guarantees   a periodic processor is silent exactly when its oldest release
--               that has not completed is overdue; a sporadic one exactly when
--               the release under way is. Silence is reported once
--  Tasking      none
--  Timing       constant

package Ravenchart.Liveness
  with SPARK_Mode, Pure
is

   type Rhythm is record
      Offset : Nanoseconds          := 0;
      Period : Positive_Nanoseconds := 1;
      Limit  : Positive_Nanoseconds := 1;
   end record;
   --  Release K is due at Offset + K * Period from the start, and has to
   --  complete within Limit from there: the deadline and a margin.

   type Progress is record
      Completed : Event_Count := 0;
      Under_Way : Boolean     := False;
      Due       : Nanoseconds := 0;
   end record;
   --  The number of completed releases, in the order in which they were due.
   --  Under_Way: a release that was due at Due has begun and not completed;
   --  only sporadic processors set it.

   function Is_Overdue
     (Beat : Rhythm; Release : Event_Count; Elapsed : Nanoseconds)
      return Boolean
   is (Nanoseconds (Release) <= Elapsed / Beat.Period
       and then Nanoseconds (Release) * Beat.Period
                <= Elapsed - Beat.Offset - Beat.Limit)
   with Global => null;
   --  Should that release have completed at Elapsed from the start? The first
   --  condition follows from the second one, and keeps it in range.

   function Is_Silent
     (Beat : Rhythm; Seen : Progress; Elapsed : Nanoseconds) return Boolean
   is (Is_Overdue (Beat, Seen.Completed, Elapsed))
   with Global => null;
   --  Is a periodic processor silent? Releases complete in order, so release
   --  number Completed is the oldest one that has not: where it is not
   --  overdue, none is.

   function Is_Stuck
     (Limit   : Positive_Nanoseconds;
      Seen    : Progress;
      Elapsed : Nanoseconds)
      return Boolean
   is (Seen.Under_Way and then Seen.Due <= Elapsed - Limit)
   with Global => null;
   --  Is a sporadic processor silent? Limit is its deadline and a margin.

   procedure Lemma_Later_Is_Not_Overdue
     (Beat : Rhythm; First, Later : Event_Count; Elapsed : Nanoseconds)
   with
     Ghost,
     Global => null,
     Pre    => First <= Later and then not Is_Overdue (Beat, First, Elapsed),
     Post   => not Is_Overdue (Beat, Later, Elapsed);
   --  No release is overdue where the oldest one is not, so Is_Silent misses
   --  no silence.

   procedure Lemma_Stays_Overdue
     (Beat : Rhythm; Release : Event_Count; Before, After : Nanoseconds)
   with
     Ghost,
     Global => null,
     Pre    => Before <= After and then Is_Overdue (Beat, Release, Before),
     Post   => Is_Overdue (Beat, Release, After);
   --  An overdue release stays overdue until it completes: the next look of a
   --  supervisor finds it.

   type Finding is (In_Time, Falls_Silent, Was_Silent);
   --  The result of one look at a processor.

   procedure Note
     (Reported : in out Boolean; Is_Silent : Boolean; Found : out Finding)
   with
     Global => null,
     Post   =>
       Reported = (Reported'Old or else Is_Silent)
       and then Found = (if Reported'Old then Was_Silent
                         elsif Is_Silent then Falls_Silent
                         else In_Time);
   --  Falls_Silent is found once: Reported never becomes False again.

end Ravenchart.Liveness;
