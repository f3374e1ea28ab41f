--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The time-outs of one region, counted in executions of its activity.
--
--  Guarantees   the earliest expiry is taken first, ties in model order; all
--               stated by the contracts
--  Tasking      none of its own: the region's activity owns its timers
--  Timing       linear in the number of timers

package Ravenchart.Timers
  with SPARK_Mode, Pure
is

   type Remaining_Count is range -(2**31) .. 2**31 - 1;
   --  Executions until expiry; below zero, executions since.

   type Timer is record
      Armed     : Boolean := False;
      Remaining : Remaining_Count := 0;
      Period    : Execution_Count := 0;
   end record;
   --  One time-out of a state; with a Period it starts again at each expiry.

   type Timer_Array is array (Positive range <>) of Timer;
   --  All time-outs of a region, in model order.

   Stopped : constant Timer := (Armed => False, Remaining => 0, Period => 0);
   --  The timer of a state that is not active, or whose expiry was taken.

   function Started
     (Executions : Execution_Count; Period : Execution_Count := 0) return Timer
   is (Armed     => True,
       Remaining => Remaining_Count (Executions),
       Period    => Period)
   with Global => null;
   --  Expires after so many executions, and then once in each Period.

   function Moved
     (T               : Timer;
      Spanned         : Boolean;
      Before, After   : Boolean;
      Fresh           : Timer) return Timer
   is (if not Spanned
       then T
       elsif After
       then Fresh
       elsif Before
       then Stopped
       else T)
   with Global => null;
   --  T of a state after a transition. The state was active Before and is
   --  active After. Where the transition Spanned it, the state was exited and
   --  entered; T then starts again as Fresh.

   function Is_Due (T : Timer) return Boolean
   is (T.Armed and then T.Remaining <= 0)
   with Global => null;
   --  Has T expired and not yet been taken?

   function Ticked (T : Timer) return Timer
   is (if T.Armed and then T.Remaining > Remaining_Count'First
       then (Armed     => True,
             Remaining => T.Remaining - 1,
             Period    => T.Period)
       else T)
   with Global => null;
   --  T one execution later.

   function Expired (T : Timer) return Timer
   is (if T.Period = 0
       then Stopped
       else (Armed     => T.Armed,
             Remaining => T.Remaining + Remaining_Count (T.Period),
             Period    => T.Period))
   with
     Global => null,
     Pre    => T.Remaining <= 0;
   --  T after its expiry was taken: disarmed, or one period on, without drift.

   function Precedes
     (Timers : Timer_Array; Left, Right : Positive) return Boolean
   is (Timers (Left).Remaining < Timers (Right).Remaining
       or else (Timers (Left).Remaining = Timers (Right).Remaining
                and then Left <= Right))
   with
     Global => null,
     Pre    => Left in Timers'Range and then Right in Timers'Range;
   --  Did Left expire before Right, or with it and stands no later?

   function Is_Taken
     (Before, After : Timer_Array; Due : Natural) return Boolean
   is (Due in Before'Range
       and then Is_Due (Before (Due))
       and then (for all I in Before'Range =>
                   (if Is_Due (Before (I)) then Precedes (Before, Due, I)))
       and then After (Due) = Expired (Before (Due))
       and then (for all I in Before'Range =>
                   (if I /= Due then After (I) = Before (I))))
   with
     Global => null,
     Pre    =>
       Before'First = After'First and then Before'Last = After'Last;
   --  Is Due the timer that expired earliest, and the only one changed?

   procedure Arm
     (T          : out Timer;
      Executions : Execution_Count;
      Period     : Execution_Count := 0)
   with
     Global => null,
     Post   => T = Started (Executions, Period);
   --  Let T expire after so many executions, and then once in each Period.

   procedure Disarm (T : out Timer)
   with
     Global => null,
     Post   => T = Stopped;
   --  Cancel T.

   procedure Tick (Timers : in out Timer_Array)
   with
     Global => null,
     Post   =>
       (for all I in Timers'Range => Timers (I) = Ticked (Timers'Old (I)));
   --  One more execution has begun.

   procedure Take_Due (Timers : in out Timer_Array; Due : out Natural)
   with
     Global => null,
     Post   =>
       (Due /= 0) = (for some T of Timers'Old => Is_Due (T))
       and then (if Due = 0
                 then Timers = Timers'Old
                 else Is_Taken (Timers'Old, Timers, Due));
   --  Take the timer that expired earliest: Due is its index, or 0 when none
   --  is due.

end Ravenchart.Timers;
