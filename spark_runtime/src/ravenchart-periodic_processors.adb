with Ada.Real_Time;
with Ravenchart.Epochs;
with Ravenchart.Failures;

package body Ravenchart.Periodic_Processors
  with SPARK_Mode
is
   use type Ada.Real_Time.Time;

   task body Processor is
      Step    : constant Ada.Real_Time.Time_Span := Epochs.To_Span (Period);
      Due     : Ada.Real_Time.Time := Epochs.Start + Epochs.To_Span (Offset);
      Release : Natural := 0;
      --  The number of the release, as far as the table can tell.
   begin
      Failures.Register (Name);
      loop
         delay until Due;
         Releases.Run (Release, Due);
         Due     := Due + Step;
         Release := (if Release < Cycle - 1 then Release + 1 else 0);
      end loop;
   end Processor;

end Ravenchart.Periodic_Processors;
