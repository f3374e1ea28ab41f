--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The process around a controller. Without RAVENCHART_TRACE the report goes
--  to a full disk; with it, a reader can check the file.

with Ada.Environment_Variables;
with Ada.Real_Time;
with Interfaces.C;
with Facts;
with Ravenchart.Health;
with Ravenchart.Hosts;
with Ravenchart.Traces;

procedure Test_Host is
   use type Ada.Real_Time.Time;
   use type Interfaces.C.int;

   function C_Raise (Signal : Interfaces.C.int) return Interfaces.C.int
   with Import, Convention => C, External_Name => "raise";

   Name   : constant String := "RAVENCHART_TRACE";
   Result : Interfaces.C.int;
   Stop   : Boolean;
begin
   if not Ada.Environment_Variables.Exists (Name) then
      Ada.Environment_Variables.Set (Name, "/dev/full");
   end if;
   Ravenchart.Hosts.Start;
   for I in 1 .. 2_000 loop
      Ravenchart.Hosts.Put_Trace
        ((At_Time => 1_000,
          Kind    => Ravenchart.Traces.Transition,
          Element => 17,
          Value   => -I));
   end loop;
   Ravenchart.Hosts.Put_Processor (1, 2, 3, 4, 5);
   Ravenchart.Hosts.Put_Queue (6, (Now => 7, Highest => 8));
   Ravenchart.Hosts.Put_Activity (5, 6);
   Ravenchart.Hosts.Put_Fault_Count (Ravenchart.Health.Can_Bus_Off, 7);
   Ravenchart.Hosts.Put_Lost ("trace", 8);
   Facts.Check ("a report never disturbs the controller", True);
   Stop := Ravenchart.Hosts.Stop_Requested;
   Facts.Check ("nobody has asked for the end", not Stop);
   Result := C_Raise (13);
   Stop   := Ravenchart.Hosts.Stop_Requested;
   Facts.Check ("a broken pipe is ignored", Result = 0 and then not Stop);
   Result := C_Raise (15);
   delay until Ada.Real_Time.Clock + Ada.Real_Time.Milliseconds (10);
   Stop   := Ravenchart.Hosts.Stop_Requested;
   Facts.Check ("SIGTERM asks for the end", Result = 0 and then Stop);
   Ravenchart.Hosts.Finish (Success => Facts.All_Hold);
end Test_Host;
