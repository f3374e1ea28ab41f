with Ada.Real_Time;
with Ravenchart.Blackboards;
with Ravenchart.Epochs;
with Ravenchart.Failures;

package body Ravenchart.Host_Probes
  with
    SPARK_Mode,
    Refined_State => (State => (Board.State, Probe))
is
   use type Ada.Real_Time.Time;

   package Board is new Blackboards
     (Element_Type => Nanoseconds,
      Initial      => 0,
      Ceiling      => Probe_Priority);

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Probe
   with Priority => Probe_Priority, Storage_Size => Stack_Bytes;
   --  Never terminates.

   procedure Read (Longest : out Nanoseconds)
   with Refined_Global => (Input => Board.State)
   is
   begin
      Board.Read (Longest);
   end Read;

   task body Probe is
      Step  : constant Ada.Real_Time.Time_Span := Epochs.To_Span (Period);
      Due   : Ada.Real_Time.Time := Epochs.Start;
      Late  : Nanoseconds;
      Worst : Nanoseconds := 0;
      Now   : Ada.Real_Time.Time;
   begin
      Failures.Register (Name);
      loop
         delay until Due;
         Now  := Ada.Real_Time.Clock;
         Late := Epochs.To_Nanoseconds (Now - Due);
         if Late > Worst then
            Worst := Late;
            Board.Write (Worst);
         end if;
         Due := Due + Step;
         if Due < Now then
            Due := Now + Step;
            --  wake-ups that a long stall has swallowed tell nothing new
         end if;
      end loop;
   end Probe;

end Ravenchart.Host_Probes;
