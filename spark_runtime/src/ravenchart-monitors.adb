--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Monitors
  with SPARK_Mode, Refined_State => (State => Observed)
is
   protected Observed
     with Priority => Ceiling
   is
      procedure Start_One (Due : Nanoseconds);

      procedure Add
        (Response : Nanoseconds; Missed : Boolean; Times : Execution_Times);

      function Summary return Statistics;

      function Position return Liveness.Progress;

   private
      Sum       : Statistics;
      Under_Way : Boolean     := False;
      Begun_For : Nanoseconds := 0;
   end Observed;

   procedure Note
     (S        : in out Statistics;
      Response : Nanoseconds;
      Missed   : Boolean;
      Times    : Execution_Times) is
   begin
      S.Releases := Next (S.Releases);
      if Missed then
         S.Misses := Next (S.Misses);
      end if;
      S.Last_Response  := Response;
      S.Worst_Response := Nanoseconds'Max (S.Worst_Response, Response);
      for A in Activity_Id loop
         S.Worst_Execution (A) :=
           Nanoseconds'Max (S.Worst_Execution (A), Times (A));
         pragma Loop_Invariant
           (for all B in Activity_Id =>
              S.Worst_Execution (B) =
                (if B <= A
                 then Nanoseconds'Max
                   (S.Worst_Execution'Loop_Entry (B), Times (B))
                 else S.Worst_Execution'Loop_Entry (B)));
      end loop;
   end Note;

   protected body Observed is

      procedure Start_One (Due : Nanoseconds) is
      begin
         Under_Way := True;
         Begun_For := Due;
      end Start_One;

      procedure Add
        (Response : Nanoseconds; Missed : Boolean; Times : Execution_Times) is
      begin
         Note (Sum, Response, Missed, Times);
         Under_Way := False;
      end Add;

      function Summary return Statistics
      is (Sum);

      function Position return Liveness.Progress
      is (Completed => Sum.Releases,
          Under_Way => Under_Way,
          Due       => Begun_For);

   end Observed;

   procedure Record_Begin (Due : Nanoseconds)
   with Refined_Global => (In_Out => Observed)
   is
   begin
      Observed.Start_One (Due);
   end Record_Begin;

   procedure Record_Release
     (Response : Nanoseconds; Missed : Boolean; Times : Execution_Times)
   with Refined_Global => (In_Out => Observed)
   is
   begin
      Observed.Add (Response, Missed, Times);
   end Record_Release;

   procedure Read (S : out Statistics)
   with Refined_Global => Observed
   is
   begin
      S := Observed.Summary;
   end Read;

   procedure Read_Progress (Seen : out Liveness.Progress)
   with Refined_Global => Observed
   is
   begin
      Seen := Observed.Position;
   end Read_Progress;

end Ravenchart.Monitors;
