--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Sends a frame that the filter refuses, then one that comes back.

with Bus_Ends;
with Ravenchart;
with Ravenchart.Can;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Hosts;

procedure Can_By_Hand_Main is
   package Can renames Ravenchart.Can;
   package Any_Frames renames Can.Any_Frames;

   use type Any_Frames.Any_Frame;
   use type Can.Send_Status;
   use type Ravenchart.Nanoseconds;

   Sent : constant Any_Frames.Any_Frame :=
     Any_Frames.To_Any
       (Can.Data_Frame (16#123#, Can.Standard, 8, 16#0102_0304#));
   Refused : constant Any_Frames.Any_Frame :=
     Any_Frames.To_Any (Can.Data_Frame (16#012#, Can.Standard, 0, 0));
   Got           : Any_Frames.Any_Frame;
   Stamp         : Ravenchart.Nanoseconds;
   First, Second : Can.Send_Status;
begin
   Ravenchart.Hosts.Start;
   Bus_Ends.Controller.Send (Refused, First);
   Bus_Ends.Controller.Send (Sent, Second);
   Bus_Ends.Controller.Wait_Frame (Got, Stamp);
   Ravenchart.Hosts.Finish
     (Success =>
        First = Can.Queued
        and then Second = Can.Queued
        and then Stamp < 1_000_000_000
        and then Got = Sent);
end Can_By_Hand_Main;
