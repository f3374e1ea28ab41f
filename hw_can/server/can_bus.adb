--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The bus server: one simulated CAN bus behind a TCP port of this machine, as
--  docs/bus-protocol.md describes it. `ravenchart bus` starts it.

with Ada.Command_Line;
with Ada.Text_IO;
with Bus_Logs;
with Bus_Options;
with Ravenchart.Can.Bus_Clients;
with Ravenchart.Can.Bus_Names;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Bus_Records;
with Ravenchart.Can.Bus_Servers;
with Ravenchart.Can.Bus_Sockets;

procedure Can_Bus is
   use Ravenchart;
   use Ravenchart.Can;
   use Ravenchart.Can.Bus_Nodes;
   use type Bus_Clients.Phase;
   use type Bus_Sockets.Writing;

   Patience : constant Nanoseconds := 100_000_000;
   --  The longest time until a signal is seen.

   Bus   : Bus_Servers.Server renames Bus_Options.Bus;
   Bytes : Bus_Records.Image;

   function Now return Nanoseconds
   is (if Bus_Servers.Is_Virtual (Bus)
       then Bus_Servers.Latest (Bus) else Bus_Sockets.Clock);
   --  Bus time.

   procedure Greet;
   --  Accept a client that wants to connect.

   procedure Listen (C : Node_Index);
   --  Read the records that C has sent.

   procedure Hand_Over
     (C : Node_Index; Horizon : Nanoseconds; Next : in out Nanoseconds);
   --  Give C the records that are due by Horizon. Next becomes at most the
   --  time of the next record, unless C accepts none now.

   -----------
   -- Greet --
   -----------

   procedure Greet is
      C : Node_Index;
   begin
      if Bus_Servers.Is_Room (Bus.Clients)
        and then Bus_Sockets.Somebody_Knocks
      then
         Bus_Servers.Connect (Bus.Clients, Bus_Sockets.Clock, C);
         Bus_Sockets.Welcome (C);
      end if;
   end Greet;

   ------------
   -- Listen --
   ------------

   procedure Listen (C : Node_Index) is
      Gone  : Boolean;
      Whole : Boolean;
   begin
      Bus_Sockets.Receive (C, Gone);
      if Gone then
         Bus_Servers.Disconnect (Bus, C);
         Bus_Sockets.Close (C);
         return;
      end if;
      loop
         Bus_Sockets.Take (C, Bytes, Whole);
         exit when not Whole;
         Bus_Servers.Take (Bus, C, Bytes, Now);
      end loop;
   end Listen;

   ---------------
   -- Hand_Over --
   ---------------

   procedure Hand_Over
     (C : Node_Index; Horizon : Nanoseconds; Next : in out Nanoseconds)
   is
      Writing : Bus_Sockets.Writing;
   begin
      loop
         while Bus_Sockets.Has_Room (C)
           and then Bus_Clients.Has_Due (Bus.Clients (C), Horizon)
         loop
            Bus_Clients.Hand_Over (Bus.Clients (C), Bytes);
            Bus_Sockets.Send (C, Bytes);
         end loop;
         Writing := Bus_Sockets.Flush (C);
         exit when Writing /= Bus_Sockets.Done
           or else not Bus_Clients.Has_Due (Bus.Clients (C), Horizon);
      end loop;
      if Writing = Bus_Sockets.Lost
        or else Bus.Clients (C).State = Bus_Clients.Given_Up
        or else
          (Bus.Clients (C).State = Bus_Clients.Ending
           and then Writing = Bus_Sockets.Done
           and then Bus.Clients (C).Queue.Count = 0)
      then
         Bus_Servers.Disconnect (Bus, C);
         Bus_Sockets.Close (C);
      elsif Writing = Bus_Sockets.Done then
         Next :=
           Nanoseconds'Min (Next, Bus_Clients.Next_Due (Bus.Clients (C)));
      end if;
   end Hand_Over;

   Port    : Natural;
   Opened  : Boolean;
   Busy    : Boolean;
   Horizon : Nanoseconds;
   Next    : Nanoseconds;
begin
   Bus_Options.Read (Port);
   Bus_Sockets.Open (Port, Opened);
   if not Opened then
      Ada.Text_IO.Put_Line
        (Ada.Text_IO.Standard_Error,
         "error: port" & Port'Image & " of this machine is not free");
      Ada.Command_Line.Set_Exit_Status (2);
      return;
   end if;
   if Bus_Options.Is_Paced then
      Bus.Profile.Began := Bus_Sockets.Date;
   end if;
   Bus_Logs.Open;
   Ada.Text_IO.Put_Line
     ("bus " & Bus_Names.Text (Bus.Profile.Name) & " at 127.0.0.1:"
      & Port'Image (2 .. Port'Image'Last));
   Ada.Text_IO.Flush;

   while not Bus_Sockets.Stop_Requested loop
      Greet;
      Bus_Servers.Expire (Bus.Clients, Bus_Sockets.Clock);
      for C in Node_Index loop
         if Bus.Clients (C).State /= Bus_Clients.Unconnected then
            Listen (C);
         end if;
      end loop;
      Horizon :=
        (if Bus_Options.Is_Paced then Now else Nanoseconds'Last);
      Bus_Servers.Run (Bus, Horizon, Busy);
      Bus_Logs.Write;
      Next := Bus_Servers.Next_Start (Bus);
      for C in Node_Index loop
         if Bus.Clients (C).State /= Bus_Clients.Unconnected then
            Hand_Over (C, Horizon, Next);
         end if;
      end loop;
      if not Busy then
         Horizon := (if Bus_Options.Is_Paced then Now else 0);
      end if;
      Bus_Sockets.Await
        ((if Busy or else Next <= Horizon then 0
          else Nanoseconds'Min (Next - Horizon, Patience)),
         Welcomes => Bus_Servers.Is_Room (Bus.Clients));
   end loop;

   Bus_Logs.Close;
   Bus_Servers.Close_All (Bus.Clients);
   for C in Node_Index loop
      if Bus.Clients (C).State /= Bus_Clients.Unconnected then
         Hand_Over (C, Nanoseconds'Last, Next);
      end if;
   end loop;
exception
   when Bus_Options.Wrong =>
      Ada.Command_Line.Set_Exit_Status (2);
end Can_Bus;
