--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Real_Time;
with Ravenchart.Epochs;
with Ravenchart.Liveness;

package body Supervised is

   Turns_Of_Stuck : Natural := 0
   with Volatile;

   Turns_Of_Served : Natural := 0;

   protected body Findings is

      procedure Add (Item : Processor; Seen : Finding) is
      begin
         Table (Item) := (Table (Item).Times + 1, Seen.Found, Seen.Before);
      end Add;

      function All_Of_Them return Finding_Table
      is (Table);

   end Findings;

   procedure Run_Stuck (Activity : Job) is
      pragma Unreferenced (Activity);
   begin
      Turns_Of_Stuck := Turns_Of_Stuck + 1;
      while Turns_Of_Stuck > 5 loop
         null;
      end loop;
   end Run_Stuck;

   procedure Wait_For_Request is
      Request : Natural;
   begin
      Requests.Wait (Request);
   end Wait_For_Request;

   procedure Run_Served (Activity : Job) is
      pragma Unreferenced (Activity);
   begin
      Turns_Of_Served := Turns_Of_Served + 1;
      if Turns_Of_Served = 2 then
         delay until Ada.Real_Time.Time_Last;
      end if;
   end Run_Served;

   procedure Observe
     (Item : Processor; Seen : out Ravenchart.Liveness.Progress);

   procedure Observe
     (Item : Processor; Seen : out Ravenchart.Liveness.Progress)
   is
   begin
      case Item is
         when Watch_Healthy => Healthy.Observe_Progress (Seen);
         when Watch_Served => Served.Observe_Progress (Seen);
         when Watch_Stuck => Stuck.Observe_Progress (Seen);
      end case;
   end Observe;

   procedure Look
     (Item      : Processor;
      Elapsed   : Ravenchart.Nanoseconds;
      Is_Silent : out Boolean)
   is
      Seen : Ravenchart.Liveness.Progress;
   begin
      Observe (Item, Seen);
      case Item is
         when Watch_Healthy =>
            Is_Silent := Ravenchart.Liveness.Is_Silent
              ((0, Period, Limit_Of_Healthy), Seen, Elapsed);
         when Watch_Stuck =>
            Is_Silent := Ravenchart.Liveness.Is_Silent
              ((2_000_000, Period, Limit), Seen, Elapsed);
         when Watch_Served =>
            Is_Silent := Ravenchart.Liveness.Is_Stuck (Limit, Seen, Elapsed);
      end case;
   end Look;

   procedure Note (Item : Processor) is
      Seen : Ravenchart.Liveness.Progress;
      Now  : Ravenchart.Nanoseconds;
   begin
      Observe (Item, Seen);
      Ravenchart.Epochs.Since_Start (Now);
      Findings.Add (Item, (1, Now, Seen.Completed));
      Ravenchart.Failures.Note_Silence
        (case Item is
            when Watch_Healthy => "healthy",
            when Watch_Served => "served",
            when Watch_Stuck => "stuck");
   end Note;

   procedure Feed is null;

end Supervised;
