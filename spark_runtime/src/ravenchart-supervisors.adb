--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Blackboards;
with Ravenchart.Epochs;
with Ravenchart.Failures;
with Ravenchart.Liveness;
with Ravenchart.Schedules;

package body Ravenchart.Supervisors
  with
    SPARK_Mode,
    Refined_State => (State => (Board.State, Supervisor))
is
   use type Liveness.Finding;

   package Board is new Blackboards
     (Element_Type => Event_Count,
      Initial      => 0,
      Ceiling      => Ceiling);

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Supervisor
   with Priority => Task_Priority, Storage_Size => Stack_Bytes;
   --  Never ends.

   procedure Read (Fed : out Event_Count)
   with Refined_Global => (Input => Board.State)
   is
   begin
      Board.Read (Fed);
   end Read;

   task body Supervisor is
      Last     : constant Event_Count := Schedules.Last_Release (0, Period);
      Release  : Event_Count := 0;
      Reported : array (Processor_Id) of Boolean := (others => False);
      Elapsed  : Nanoseconds;
      Silent   : Boolean;
      Found    : Liveness.Finding;
      Fed      : Event_Count := 0;
      Alarm    : Boolean     := False;
      First    : Nanoseconds := 0;
      --  The instant at which the first silence was found, if there is an
      --  Alarm.
   begin
      Failures.Register (Name);
      loop
         pragma Loop_Invariant (Release <= Last);
         delay until Epochs.Instant (Schedules.Due (0, Period, Release));
         Epochs.Since_Start (Elapsed);
         for Item in Processor_Id loop
            if not Reported (Item) then
               Look (Item, Elapsed, Silent);
               Liveness.Note (Reported (Item), Silent, Found);
               if Found = Liveness.Falls_Silent then
                  if not Alarm then
                     Alarm := True;
                     First := Elapsed;
                  end if;
                  On_Silence (Item);
               end if;
            end if;
         end loop;
         if not Alarm then
            Feed_Watchdog;
            Fed := Next (Fed);
            Board.Write (Fed);
         elsif Elapsed - First >= Patience then
            Give_Up;
         end if;
         Release := Event_Count'Min (Next (Release), Last);
      end loop;
   end Supervisor;

end Ravenchart.Supervisors;
