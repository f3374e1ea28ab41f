with Ada.Real_Time; use type Ada.Real_Time.Time;
with Counting;
with Ravenchart.Epochs;
with Ravenchart.Hosts;
with System;

procedure By_Hand_Main
  with SPARK_Mode, Priority => System.Priority'First
is
   use type Ravenchart.Event_Count;

   Last  : constant Ada.Real_Time.Time :=
     Ravenchart.Epochs.Start + Ada.Real_Time.Milliseconds (495);
   Shown : Ravenchart.Event_Count;
   Seen  : Counting.Processor.Statistics;
begin
   Ravenchart.Hosts.Start;
   delay until Last;
   Counting.Shown.Read (Shown);
   Counting.Processor.Observe (Seen);
   Ravenchart.Hosts.Put_Processor
     (1, Seen.Releases, Seen.Misses, Seen.Worst_Response);
   Ravenchart.Hosts.Finish (Success => Shown > 0);
end By_Hand_Main;
