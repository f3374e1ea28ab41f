--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Busy_Periods
  with SPARK_Mode
is
   function Is_Counted (Period, Wcet, Taken, Due : Ticks) return Boolean
   is (Due <= 2 * Limit
       and then Taken <= Due
       and then Due = Due / Period * Period
       and then Taken = Due / Period * Wcet)
   with
     Ghost,
     Pre => Period in 1 .. Limit - 1 and then Wcet in 1 .. Period;
   --  Taken is the execution of the releases before Due, and Due is one of the
   --  releases.

   function Are_Counted
     (Period, Wcet, Taken, Due : Times;
      Level                    : Task_Count) return Boolean
   is (for all J in 1 .. Level =>
         Is_Counted (Period (J), Wcet (J), Taken (J), Due (J)))
   with Ghost, Pre => Are_Plain (Level, Period, Wcet);
   --  Is_Counted for every task up to Level.

   procedure Count_Releases
     (Period, Wcet : Ticks;
      Window       : Ticks;
      Taken, Due   : out Ticks)
   with
     Pre  =>
       Window in 1 .. Limit
       and then Period in 1 .. Limit - 1
       and then Wcet in 1 .. Period,
     Post =>
       Due >= Window and then Is_Counted (Period, Wcet, Taken, Due);
   --  Count those within Window.

   procedure Take_In
     (Period, Wcet : Times;
      Before       : Task_Count;
      Level        : Task_Number;
      Window       : Ticks;
      Taken, Due   : in out Times)
   with
     Pre  =>
       Before < Level
       and then Are_Plain (Level, Period, Wcet)
       and then Window in 1 .. Limit
       and then Are_Counted (Period, Wcet, Taken, Due, Before),
     Post => Are_Counted (Period, Wcet, Taken, Due, Level);
   --  Count also the releases of the tasks behind Before, up to Level.

   procedure Renew
     (Period, Wcet : Times;
      Level, J     : Task_Number;
      Window       : Ticks;
      Taken, Due   : in out Times)
   with
     Pre  =>
       J <= Level
       and then Are_Plain (Level, Period, Wcet)
       and then Window in 1 .. Limit
       and then
         (for all K in 1 .. Level =>
            (if K /= J then
               Is_Counted (Period (K), Wcet (K), Taken (K), Due (K)))),
     Post =>
       Due (J) >= Window
       and then Are_Counted (Period, Wcet, Taken, Due, Level);
   --  Count the releases of task J, anew or for the first time, besides those
   --  of the other tasks.

   procedure Pass
     (Period, Wcet : Times;
      Level        : Task_Number;
      Blocked      : Ticks;
      Window       : Ticks;
      Taken, Due   : in out Times;
      Sum          : out Ticks)
   with
     Pre  =>
       Are_Plain (Level, Period, Wcet)
       and then Blocked < Limit
       and then Window in 1 .. Limit
       and then Are_Counted (Period, Wcet, Taken, Due, Level),
     Post =>
       Are_Counted (Period, Wcet, Taken, Due, Level)
       and then Sum in Blocked + Demand (Period, Wcet, Level, Window)
                  .. Blocked + Ticks (Level) * (2 * Limit);
   --  The execution of all releases within Window.

   procedure Settle
     (Period, Wcet : Times;
      Level        : Task_Number;
      Blocked      : Ticks;
      Longest      : Ticks;
      Taken, Due   : in out Times;
      Window       : in out Ticks;
      Done         : out Boolean)
   with
     Pre  =>
       Are_Plain (Level, Period, Wcet)
       and then Blocked < Limit
       and then Longest in 1 .. Limit
       and then Window in 1 .. Limit
       and then Are_Counted (Period, Wcet, Taken, Due, Level),
     Post =>
       Are_Counted (Period, Wcet, Taken, Due, Level)
       and then
         (if Done then
            Window in 1 .. Longest
            and then Blocked + Demand (Period, Wcet, Level, Window)
                     <= Window);
   --  Let Window grow until all that is released in it is executed; not Done
   --  when it would be longer than Longest.

   procedure Settle_Blocked
     (Period, Wcet : Times;
      Level        : Task_Number;
      Blocked      : Ticks;
      Longest      : Ticks;
      Taken, Due   : Times;
      Window       : Ticks;
      Found        : out Ticks)
   with
     Pre  =>
       Are_Plain (Level, Period, Wcet)
       and then Blocked < Limit
       and then Longest in 1 .. Limit
       and then Window in 1 .. Limit
       and then Are_Counted (Period, Wcet, Taken, Due, Level),
     Post =>
       Found = 0
       or else
         (Found in 1 .. Longest
          and then Blocked + Demand (Period, Wcet, Level, Found) <= Found);
   --  The same for one task that is blocked besides, and 0 for not Done.

   procedure Prove_Taken
     (Period, Wcet, Taken, Due : Ticks;
      Window                   : Ticks)
   with
     Ghost,
     Pre  =>
       Window in 1 .. Limit
       and then Period in 1 .. Limit - 1
       and then Wcet in 1 .. Period
       and then Is_Counted (Period, Wcet, Taken, Due)
       and then Due >= Window,
     Post => Taken >= ((Window - 1) / Period + 1) * Wcet;
   --  Every release within Window lies before Due, so Taken holds its
   --  execution.

   procedure Prove_Next
     (Period, Wcet : Times;
      Taken, Due   : Times;
      K            : Task_Number)
   with
     Ghost,
     Pre  =>
       Are_Plain (K, Period, Wcet)
       and then Are_Counted (Period, Wcet, Taken, Due, K - 1)
       and then Is_Counted (Period (K), Wcet (K), Taken (K), Due (K)),
     Post => Are_Counted (Period, Wcet, Taken, Due, K);
   --  One more task.

   procedure Prove_Replaced
     (Period, Wcet             : Times;
      Taken_Before, Due_Before : Times;
      Taken, Due               : Times;
      Level, J                 : Task_Number)
   with
     Ghost,
     Pre  =>
       J <= Level
       and then Are_Plain (Level, Period, Wcet)
       and then
         (for all K in 1 .. Level =>
            (if K /= J then
               Is_Counted
                 (Period (K), Wcet (K), Taken_Before (K), Due_Before (K))))
       and then
         (for all K in 1 .. Level =>
            (if K /= J then Taken (K) = Taken_Before (K)))
       and then
         (for all K in 1 .. Level => (if K /= J then Due (K) = Due_Before (K)))
       and then Is_Counted (Period (J), Wcet (J), Taken (J), Due (J)),
     Post => Are_Counted (Period, Wcet, Taken, Due, Level);
   --  The counts of the other tasks still hold.

   -----------------
   -- Prove_Taken --
   -----------------

   procedure Prove_Taken
     (Period, Wcet, Taken, Due : Ticks;
      Window                   : Ticks) is
   begin
      pragma Assert ((Window - 1) / Period + 1 <= Due / Period);
      pragma Assert
        (((Window - 1) / Period + 1) * Wcet <= Due / Period * Wcet);
      pragma Assert (Taken = Due / Period * Wcet);
   end Prove_Taken;

   ----------------
   -- Prove_Next --
   ----------------

   procedure Prove_Next
     (Period, Wcet : Times;
      Taken, Due   : Times;
      K            : Task_Number)
   is null;

   --------------------
   -- Prove_Replaced --
   --------------------

   procedure Prove_Replaced
     (Period, Wcet             : Times;
      Taken_Before, Due_Before : Times;
      Taken, Due               : Times;
      Level, J                 : Task_Number) is
   begin
      for K in 1 .. Level loop
         pragma Assert
           (K = J
            or else
              Is_Counted
                (Period (K), Wcet (K), Taken_Before (K), Due_Before (K)));
         pragma Assert
           (Is_Counted (Period (K), Wcet (K), Taken (K), Due (K)));
         Prove_Next (Period, Wcet, Taken, Due, K);
         pragma Loop_Invariant (Are_Counted (Period, Wcet, Taken, Due, K));
      end loop;
   end Prove_Replaced;

   --------------------
   -- Count_Releases --
   --------------------

   procedure Count_Releases
     (Period, Wcet : Ticks;
      Window       : Ticks;
      Taken, Due   : out Ticks)
   is
      Releases : constant Ticks := (Window - 1) / Period + 1;
   begin
      pragma Assert ((Releases - 1) * Period <= Window - 1);
      Due   := Releases * Period;
      Taken := Releases * Wcet;
      pragma Assert (Due / Period = Releases);
   end Count_Releases;

   -------------
   -- Take_In --
   -------------

   procedure Take_In
     (Period, Wcet : Times;
      Before       : Task_Count;
      Level        : Task_Number;
      Window       : Ticks;
      Taken, Due   : in out Times)
   is
   begin
      for J in Before + 1 .. Level loop
         Renew (Period, Wcet, J, J, Window, Taken, Due);
         pragma Loop_Invariant (Are_Counted (Period, Wcet, Taken, Due, J));
      end loop;
   end Take_In;

   -----------
   -- Renew --
   -----------

   procedure Renew
     (Period, Wcet : Times;
      Level, J     : Task_Number;
      Window       : Ticks;
      Taken, Due   : in out Times)
   is
      Taken_Before : constant Times := Taken with Ghost;
      Due_Before   : constant Times := Due with Ghost;
   begin
      Count_Releases (Period (J), Wcet (J), Window, Taken (J), Due (J));
      Prove_Replaced
        (Period, Wcet, Taken_Before, Due_Before, Taken, Due, Level, J);
   end Renew;

   ----------
   -- Pass --
   ----------

   procedure Pass
     (Period, Wcet : Times;
      Level        : Task_Number;
      Blocked      : Ticks;
      Window       : Ticks;
      Taken, Due   : in out Times;
      Sum          : out Ticks) is
   begin
      Sum := Blocked;
      for J in 1 .. Level loop
         if Due (J) < Window then
            Renew (Period, Wcet, Level, J, Window, Taken, Due);
         end if;
         Prove_Taken (Period (J), Wcet (J), Taken (J), Due (J), Window);
         Sum := Sum + Taken (J);
         pragma Loop_Invariant
           (Are_Counted (Period, Wcet, Taken, Due, Level));
         pragma Loop_Invariant
           (Sum in Blocked + Demand (Period, Wcet, J, Window)
              .. Blocked + Ticks (J) * (2 * Limit));
      end loop;
   end Pass;

   ------------
   -- Settle --
   ------------

   procedure Settle
     (Period, Wcet : Times;
      Level        : Task_Number;
      Blocked      : Ticks;
      Longest      : Ticks;
      Taken, Due   : in out Times;
      Window       : in out Ticks;
      Done         : out Boolean)
   is
      Sum : Ticks;
   begin
      Done := False;
      for Round in 1 .. Most_Rounds loop
         Pass (Period, Wcet, Level, Blocked, Window, Taken, Due, Sum);
         pragma Assert (Are_Counted (Period, Wcet, Taken, Due, Level));
         if Sum <= Window then
            Done := Window <= Longest;
            return;
         end if;
         exit when Sum > Longest;
         Window := Sum;
         pragma Loop_Invariant (Window in 1 .. Limit);
         pragma Loop_Invariant
           (Are_Counted (Period, Wcet, Taken, Due, Level));
      end loop;
   end Settle;

   --------------------
   -- Settle_Blocked --
   --------------------

   procedure Settle_Blocked
     (Period, Wcet : Times;
      Level        : Task_Number;
      Blocked      : Ticks;
      Longest      : Ticks;
      Taken, Due   : Times;
      Window       : Ticks;
      Found        : out Ticks)
   is
      Own_Taken : Times := Taken;
      Own_Due   : Times := Due;
      Is_Short  : Boolean;
   begin
      Found := Window;
      pragma Warnings
        (GNATprove, Off, """Own_*"" is set by*",
         Reason => "the window of other levels goes on without blocking");
      Settle
        (Period, Wcet, Level, Blocked, Longest, Own_Taken, Own_Due, Found,
         Is_Short);
      pragma Warnings (GNATprove, On, """Own_*"" is set by*");
      if not Is_Short then
         Found := 0;
      end if;
   end Settle_Blocked;

   ----------
   -- Find --
   ----------

   procedure Find
     (Count        : Task_Count;
      Period, Wcet : Times;
      Last         : Levels;
      Blocked      : Times;
      Found        : in out Times)
   is
      Level      : Task_Count := 0;
      Window     : Ticks := 1;
      Taken, Due : Times := (others => 0);
      --  Without blocking; it goes on from level to level.
      Longest    : Ticks := 1;
      Is_Settled : Boolean := True;
   begin
      for J in 1 .. Count loop
         Longest := Ticks'Max (Longest, Period (J));
         pragma Loop_Invariant (Longest in 1 .. Limit);
      end loop;
      for J in 1 .. Count loop
         if Is_Settled and then Level < Last (J) then
            Take_In
              (Period, Wcet, Level, Last (J), Window, Taken, Due);
            Level := Last (J);
            Settle
              (Period, Wcet, Level, 0, Longest, Taken, Due, Window,
               Is_Settled);
         end if;
         Found (J) := 0;
         if Is_Settled and then Level = Last (J) then
            if Blocked (J) = 0 then
               if Window <= Period (J) then
                  Found (J) := Window;
               end if;
            else
               Settle_Blocked
                 (Period, Wcet, Level, Blocked (J), Period (J),
                  Taken, Due, Window, Found (J));
            end if;
         end if;
         pragma Loop_Invariant
           (Level in J .. Count or else not Is_Settled);
         pragma Loop_Invariant (Level <= Count);
         pragma Loop_Invariant
           (if Is_Settled then
              Window in 1 .. Limit
              and then Are_Counted (Period, Wcet, Taken, Due, Level)
              and then Demand (Period, Wcet, Level, Window) <= Window);
         pragma Loop_Invariant
           (for all K in 1 .. J =>
              Found (K) = 0
              or else
                (Found (K) in 1 .. Period (K)
                 and then Blocked (K)
                          + Demand (Period, Wcet, Last (K), Found (K))
                          <= Found (K)));
      end loop;
   end Find;

end Busy_Periods;
