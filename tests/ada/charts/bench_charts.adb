--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Generated code against nested case statements written by hand: the same
--  chart, the same actions, the same switches, one run.

with Chart_Bench.Unit.Motion;
with GNAT.OS_Lib;
with Hand_Written;
with Measuring;

procedure Bench_Charts is
   package Motion renames Chart_Bench.Unit.Motion;

   Region  : Motion.Region;
   Fired   : Motion.Selection;
   Machine : Hand_Written.Machine;
   Taken   : Boolean;

   procedure Generated_Move (Value : Integer) is
   begin
      Motion.Step
        (Region,
         (if Value mod 2 = 1 then Motion.On_Go else Motion.On_Back),
         Fired);
   end Generated_Move;

   procedure Written_Move (Value : Integer) is
   begin
      Hand_Written.Dispatch
        (Machine,
         (if Value mod 2 = 1 then Hand_Written.Go else Hand_Written.Back),
         Taken);
   end Written_Move;

   procedure Generated_Internal (Value : Integer) is
      pragma Unreferenced (Value);
   begin
      Motion.Step (Region, Motion.On_Tick, Fired);
   end Generated_Internal;

   procedure Written_Internal (Value : Integer) is
      pragma Unreferenced (Value);
   begin
      Hand_Written.Dispatch (Machine, Hand_Written.Tick, Taken);
   end Written_Internal;

   procedure Generated_Nothing (Value : Integer) is
      pragma Unreferenced (Value);
   begin
      Motion.Step (Region, Motion.On_Unknown, Fired);
   end Generated_Nothing;

   procedure Written_Nothing (Value : Integer) is
      pragma Unreferenced (Value);
   begin
      Hand_Written.Dispatch (Machine, Hand_Written.Unknown, Taken);
   end Written_Nothing;

   procedure Move is new Measuring.Compare (Generated_Move, Written_Move);
   procedure Internal is
     new Measuring.Compare (Generated_Internal, Written_Internal);
   procedure Nothing is
     new Measuring.Compare (Generated_Nothing, Written_Nothing);
begin
   Motion.Step (Region, Motion.Start_Of_Region, Fired);
   Hand_Written.Start (Machine);
   Move ("leaf to leaf across two levels:");
   Internal ("internal transition:");
   Nothing ("unhandled event, three levels:");
   GNAT.OS_Lib.OS_Exit (0);
end Bench_Charts;
