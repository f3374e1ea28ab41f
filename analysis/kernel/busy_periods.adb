--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Busy_Periods
  with SPARK_Mode
is
   function Is_Counted (Period, Cost, Taken, Due : Ticks) return Boolean
   is (Due <= 2 * Limit
       and then Taken <= Due
       and then Due = Due / Period * Period
       and then Taken = Due / Period * Cost)
   with
     Ghost,
     Pre => Period in 1 .. Limit - 1 and then Cost in 1 .. Period;
   --  Taken is what the releases before Due execute, and Due is one.

   function Are_Counted
     (Period, Cost, Taken, Due : Times;
      Level                    : Task_Count) return Boolean
   is (for all J in 1 .. Level =>
         Is_Counted (Period (J), Cost (J), Taken (J), Due (J)))
   with Ghost, Pre => Are_Plain (Level, Period, Cost);
   --  That of every task up to Level.

   procedure Count_Releases
     (Period, Cost : Ticks;
      Window       : Ticks;
      Taken, Due   : out Ticks)
   with
     Pre  =>
       Window in 1 .. Limit
       and then Period in 1 .. Limit - 1
       and then Cost in 1 .. Period,
     Post =>
       Due >= Window and then Is_Counted (Period, Cost, Taken, Due);
   --  Count those within Window.

   procedure Take_One
     (Period, Cost : Times;
      J            : Task_Number;
      Window       : Ticks;
      Taken, Due   : in out Times)
   with
     Pre  =>
       Are_Plain (J, Period, Cost)
       and then Window in 1 .. Limit
       and then Are_Counted (Period, Cost, Taken, Due, J - 1),
     Post => Are_Counted (Period, Cost, Taken, Due, J);
   --  Count the releases of task J besides those of the tasks before it.

   procedure Take_In
     (Period, Cost : Times;
      Before       : Task_Count;
      Level        : Task_Number;
      Window       : Ticks;
      Taken, Due   : in out Times)
   with
     Pre  =>
       Before < Level
       and then Are_Plain (Level, Period, Cost)
       and then Window in 1 .. Limit
       and then Are_Counted (Period, Cost, Taken, Due, Before),
     Post => Are_Counted (Period, Cost, Taken, Due, Level);
   --  Count also the releases of the tasks behind Before, up to Level.

   procedure Renew
     (Period, Cost : Times;
      Level, J     : Task_Number;
      Window       : Ticks;
      Taken, Due   : in out Times)
   with
     Pre  =>
       J <= Level
       and then Are_Plain (Level, Period, Cost)
       and then Window in 1 .. Limit
       and then Are_Counted (Period, Cost, Taken, Due, Level),
     Post =>
       Due (J) >= Window
       and then Are_Counted (Period, Cost, Taken, Due, Level);
   --  Count the releases of task J anew.

   procedure Pass
     (Period, Cost : Times;
      Level        : Task_Number;
      Blocked      : Ticks;
      Window       : Ticks;
      Taken, Due   : in out Times;
      Sum          : out Ticks)
   with
     Pre  =>
       Are_Plain (Level, Period, Cost)
       and then Blocked < Limit
       and then Window in 1 .. Limit
       and then Are_Counted (Period, Cost, Taken, Due, Level),
     Post =>
       Are_Counted (Period, Cost, Taken, Due, Level)
       and then Sum in Blocked + Demand (Period, Cost, Level, Window)
                  .. Blocked + Ticks (Level) * (2 * Limit);
   --  What is executed of all that is released within Window.

   procedure Settle
     (Period, Cost : Times;
      Level        : Task_Number;
      Blocked      : Ticks;
      Longest      : Ticks;
      Taken, Due   : in out Times;
      Window       : in out Ticks;
      Done         : out Boolean)
   with
     Pre  =>
       Are_Plain (Level, Period, Cost)
       and then Blocked < Limit
       and then Longest in 1 .. Limit
       and then Window in 1 .. Limit
       and then Are_Counted (Period, Cost, Taken, Due, Level),
     Post =>
       Are_Counted (Period, Cost, Taken, Due, Level)
       and then
         (if Done then
            Window in 1 .. Longest
            and then Blocked + Demand (Period, Cost, Level, Window)
                     <= Window);
   --  Let Window grow until all that is released in it is executed; not Done
   --  when it would be longer than Longest.

   procedure Settle_Blocked
     (Period, Cost : Times;
      Level        : Task_Number;
      Blocked      : Ticks;
      Longest      : Ticks;
      Taken, Due   : Times;
      Window       : Ticks;
      Found        : out Ticks)
   with
     Pre  =>
       Are_Plain (Level, Period, Cost)
       and then Blocked < Limit
       and then Longest in 1 .. Limit
       and then Window in 1 .. Limit
       and then Are_Counted (Period, Cost, Taken, Due, Level),
     Post =>
       Found = 0
       or else
         (Found in 1 .. Longest
          and then Blocked + Demand (Period, Cost, Level, Found) <= Found);
   --  The same for one task that is blocked besides, and 0 for not Done.

   procedure Prove_Taken
     (Period, Cost, Taken, Due : Ticks;
      Window                   : Ticks)
   with
     Ghost,
     Pre  =>
       Window in 1 .. Limit
       and then Period in 1 .. Limit - 1
       and then Cost in 1 .. Period
       and then Is_Counted (Period, Cost, Taken, Due)
       and then Due >= Window,
     Post => Taken >= ((Window - 1) / Period + 1) * Cost;
   --  Up to the next release nothing is added.

   procedure Prove_Next
     (Period, Cost : Times;
      Taken, Due   : Times;
      K            : Task_Number)
   with
     Ghost,
     Pre  =>
       Are_Plain (K, Period, Cost)
       and then Are_Counted (Period, Cost, Taken, Due, K - 1)
       and then Is_Counted (Period (K), Cost (K), Taken (K), Due (K)),
     Post => Are_Counted (Period, Cost, Taken, Due, K);
   --  One task more.

   procedure Prove_Replaced
     (Period, Cost             : Times;
      Taken_Before, Due_Before : Times;
      Taken, Due               : Times;
      Level, J                 : Task_Number)
   with
     Ghost,
     Pre  =>
       J <= Level
       and then Are_Plain (Level, Period, Cost)
       and then
         (for all K in 1 .. Level =>
            (if K /= J then
               Is_Counted
                 (Period (K), Cost (K), Taken_Before (K), Due_Before (K))))
       and then
         (for all K in 1 .. Level =>
            (if K /= J then Taken (K) = Taken_Before (K)))
       and then
         (for all K in 1 .. Level => (if K /= J then Due (K) = Due_Before (K)))
       and then Is_Counted (Period (J), Cost (J), Taken (J), Due (J)),
     Post => Are_Counted (Period, Cost, Taken, Due, Level);
   --  What was counted of the other tasks still is.

   -----------------
   -- Prove_Taken --
   -----------------

   procedure Prove_Taken
     (Period, Cost, Taken, Due : Ticks;
      Window                   : Ticks) is
   begin
      pragma Assert ((Window - 1) / Period + 1 <= Due / Period);
      pragma Assert
        (((Window - 1) / Period + 1) * Cost <= Due / Period * Cost);
      pragma Assert (Taken = Due / Period * Cost);
   end Prove_Taken;

   ----------------
   -- Prove_Next --
   ----------------

   procedure Prove_Next
     (Period, Cost : Times;
      Taken, Due   : Times;
      K            : Task_Number)
   is null;

   --------------------
   -- Prove_Replaced --
   --------------------

   procedure Prove_Replaced
     (Period, Cost             : Times;
      Taken_Before, Due_Before : Times;
      Taken, Due               : Times;
      Level, J                 : Task_Number) is
   begin
      for K in 1 .. Level loop
         pragma Assert
           (K = J
            or else
              Is_Counted
                (Period (K), Cost (K), Taken_Before (K), Due_Before (K)));
         pragma Assert
           (Is_Counted (Period (K), Cost (K), Taken (K), Due (K)));
         Prove_Next (Period, Cost, Taken, Due, K);
         pragma Loop_Invariant (Are_Counted (Period, Cost, Taken, Due, K));
      end loop;
   end Prove_Replaced;

   --------------------
   -- Count_Releases --
   --------------------

   procedure Count_Releases
     (Period, Cost : Ticks;
      Window       : Ticks;
      Taken, Due   : out Ticks)
   is
      Releases : constant Ticks := (Window - 1) / Period + 1;
   begin
      pragma Assert ((Releases - 1) * Period <= Window - 1);
      Due   := Releases * Period;
      Taken := Releases * Cost;
      pragma Assert (Due / Period = Releases);
   end Count_Releases;

   --------------
   -- Take_One --
   --------------

   procedure Take_One
     (Period, Cost : Times;
      J            : Task_Number;
      Window       : Ticks;
      Taken, Due   : in out Times)
   is
      Taken_Before : constant Times := Taken with Ghost;
      Due_Before   : constant Times := Due with Ghost;
   begin
      Count_Releases (Period (J), Cost (J), Window, Taken (J), Due (J));
      Prove_Replaced
        (Period, Cost, Taken_Before, Due_Before, Taken, Due, J, J);
   end Take_One;

   -------------
   -- Take_In --
   -------------

   procedure Take_In
     (Period, Cost : Times;
      Before       : Task_Count;
      Level        : Task_Number;
      Window       : Ticks;
      Taken, Due   : in out Times)
   is
   begin
      for J in Before + 1 .. Level loop
         Take_One (Period, Cost, J, Window, Taken, Due);
         pragma Loop_Invariant (Are_Counted (Period, Cost, Taken, Due, J));
      end loop;
   end Take_In;

   -----------
   -- Renew --
   -----------

   procedure Renew
     (Period, Cost : Times;
      Level, J     : Task_Number;
      Window       : Ticks;
      Taken, Due   : in out Times)
   is
      Taken_Before : constant Times := Taken with Ghost;
      Due_Before   : constant Times := Due with Ghost;
   begin
      Count_Releases (Period (J), Cost (J), Window, Taken (J), Due (J));
      Prove_Replaced
        (Period, Cost, Taken_Before, Due_Before, Taken, Due, Level, J);
   end Renew;

   ----------
   -- Pass --
   ----------

   procedure Pass
     (Period, Cost : Times;
      Level        : Task_Number;
      Blocked      : Ticks;
      Window       : Ticks;
      Taken, Due   : in out Times;
      Sum          : out Ticks) is
   begin
      Sum := Blocked;
      for J in 1 .. Level loop
         if Due (J) < Window then
            Renew (Period, Cost, Level, J, Window, Taken, Due);
         end if;
         Prove_Taken (Period (J), Cost (J), Taken (J), Due (J), Window);
         Sum := Sum + Taken (J);
         pragma Loop_Invariant
           (Are_Counted (Period, Cost, Taken, Due, Level));
         pragma Loop_Invariant
           (Sum in Blocked + Demand (Period, Cost, J, Window)
              .. Blocked + Ticks (J) * (2 * Limit));
      end loop;
   end Pass;

   ------------
   -- Settle --
   ------------

   procedure Settle
     (Period, Cost : Times;
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
         Pass (Period, Cost, Level, Blocked, Window, Taken, Due, Sum);
         if Sum <= Window then
            Done := Window <= Longest;
            return;
         end if;
         exit when Sum > Longest;
         Window := Sum;
         pragma Loop_Invariant (Window in 1 .. Limit);
         pragma Loop_Invariant
           (Are_Counted (Period, Cost, Taken, Due, Level));
      end loop;
   end Settle;

   --------------------
   -- Settle_Blocked --
   --------------------

   procedure Settle_Blocked
     (Period, Cost : Times;
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
        (Period, Cost, Level, Blocked, Longest, Own_Taken, Own_Due, Found,
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
      Period, Cost : Times;
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
              (Period, Cost, Level, Last (J), Window, Taken, Due);
            Level := Last (J);
            Settle
              (Period, Cost, Level, 0, Longest, Taken, Due, Window,
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
                 (Period, Cost, Level, Blocked (J), Period (J),
                  Taken, Due, Window, Found (J));
            end if;
         end if;
         pragma Loop_Invariant
           (Level in J .. Count or else not Is_Settled);
         pragma Loop_Invariant (Level <= Count);
         pragma Loop_Invariant
           (if Is_Settled then
              Window in 1 .. Limit
              and then Are_Counted (Period, Cost, Taken, Due, Level)
              and then Demand (Period, Cost, Level, Window) <= Window);
         pragma Loop_Invariant
           (for all K in 1 .. J =>
              Found (K) = 0
              or else
                (Found (K) in 1 .. Period (K)
                 and then Blocked (K)
                          + Demand (Period, Cost, Last (K), Found (K))
                          <= Found (K)));
      end loop;
   end Find;

end Busy_Periods;
