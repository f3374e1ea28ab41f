--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Blackboards;
with Ravenchart.Epochs;
with Ravenchart.Failures;
with Ravenchart.Schedules;

package body Ravenchart.Host_Probes
  with
    SPARK_Mode,
    Refined_State => (State => (Board.State, Probe))
is
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
      Last    : constant Event_Count := Schedules.Last_Release (0, Period);
      Release : Event_Count := 0;
      Due     : Nanoseconds;
      Now     : Nanoseconds;
      Worst   : Nanoseconds := 0;
   begin
      Failures.Register (Name);
      loop
         pragma Loop_Invariant (Release <= Last);
         Due := Schedules.Due (0, Period, Release);
         delay until Epochs.Instant (Due);
         Epochs.Since_Start (Now);
         if Now > Due and then Now - Due > Worst then
            Worst := Now - Due;
            Board.Write (Worst);
         end if;
         Release := Event_Count'Min (Next (Event_Count (Now / Period)), Last);
         --  Skip the wake-ups that fell into a long stall: they measure
         --  nothing new.
      end loop;
   end Probe;

end Ravenchart.Host_Probes;
