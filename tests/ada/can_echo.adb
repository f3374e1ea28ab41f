--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A node of a bus, as a process: it runs package Echoes under the number on
--  its command line, and prints its state after each change. It ends when its
--  output has no reader any more. It takes CAN FD frames unless
--  CAN_ECHO_CLASSIC is set. CAN_ECHO_ON_REQUEST is the time in bus-off, in
--  milliseconds, before it requests recovery; with 0 it requests none.

with Ada.Command_Line;
with Ada.Environment_Variables;
with Ada.Real_Time;
with Ada.Text_IO;
with Echoes;
with Nodes;
with Ravenchart;
with Ravenchart.Can;
with Ravenchart.Can.Fault_Notices;

procedure Can_Echo is
   use type Ada.Real_Time.Time;
   use type Ravenchart.Can.Controller_State;
   use type Ravenchart.Can.Counters;

   Now   : Ravenchart.Can.Controller_State := Ravenchart.Can.Stopped;
   Count : Ravenchart.Can.Counters;
   State : Ravenchart.Can.Controller_State;
   Last  : Ravenchart.Can.Counters;
   Log   : Ravenchart.Can.Fault_Notices.Fault_Log;
   Off   : Natural := 0;
   Limit : constant Natural :=
     Natural'Value
       (Ada.Environment_Variables.Value ("CAN_ECHO_ON_REQUEST", "0"));
begin
   Echoes.Number := Natural'Value (Ada.Command_Line.Argument (1));
   loop
      Nodes.Node.Read_State (State);
      Nodes.Node.Read_Counters (Count);
      Nodes.Node.Read_Faults (Log);
      Off := (if State = Ravenchart.Can.Bus_Off then Off + 1 else 0);
      if Limit > 0 and then Off = Limit then
         Nodes.Node.Request_Recovery;
      end if;
      if State /= Now or else Count /= Last then
         Now  := State;
         Last := Count;
         Ada.Text_IO.Put_Line
           (State'Image
            & " sent=" & Count.Sent'Image
            & " received=" & Count.Received'Image
            & " lost_out=" & Count.Lost_Out'Image
            & " lost_in=" & Count.Lost_In'Image
            & " rejected=" & Count.Rejected_Lines'Image
            & " tec=" & Count.Transmit_Errors'Image
            & " rec=" & Count.Receive_Errors'Image
            & " passive=" & Log.Passive_Entries'Image
            & " off=" & Log.Off_Entries'Image
            & " back=" & Log.Returns'Image);
      end if;
      delay until Ada.Real_Time.Clock + Ada.Real_Time.Milliseconds (1);
   end loop;
end Can_Echo;
