--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A controller on the loopback bus.

with Ada.Real_Time;
with Facts;
with Nodes;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Epochs;

procedure Test_Controller is
   use Ravenchart.Can;
   use Ravenchart.Can.Fd_Frames;
   use type Ada.Real_Time.Time;
   use type Ravenchart.Event_Count;
   use type Ravenchart.Nanoseconds;

   use type Any_Frames.Any_Frame;

   Base : constant Frame_Format := Ravenchart.Can.Standard;
   --  The literal alone would be hidden by package Standard.

   procedure Settle;
   --  Wait until the bus has carried the frames that were sent.

   procedure Await (Received : Ravenchart.Event_Count);
   --  Wait until so many frames have come, for a minute at most: the machine
   --  may be busy.

   procedure Settle is
   begin
      delay until Ada.Real_Time.Clock + Ada.Real_Time.Milliseconds (200);
   end Settle;

   procedure Await (Received : Ravenchart.Event_Count) is
      Seen : Counters;
   begin
      for Turn in 1 .. 300 loop
         Settle;
         Nodes.Node.Read_Counters (Seen);
         exit when Seen.Received >= Received;
      end loop;
   end Await;

   Status : Send_Status;
   State  : Controller_State;
   Count  : Counters;
   F      : Frame;
   Any    : Any_Frames.Any_Frame;
   Long   : Fd_Frame;
   Right  : Boolean := True;
   Before : Ravenchart.Nanoseconds;
   After  : Ravenchart.Nanoseconds;
   Stamp  : Ravenchart.Nanoseconds;
begin
   Settle;
   Nodes.Node.Read_State (State);
   Facts.Check ("the controller is active", State = Error_Active);
   for I in 1 .. 50 loop
      Nodes.Send
        (Data_Frame (Identifier (I), Base, 2, 16#0101#), Status);
      Right := Right and then Status = Queued;
   end loop;
   Facts.Check ("frames are queued", Right);
   for I in 1 .. 50 loop
      Nodes.Wait_Frame (F, Stamp);
      Right := Right
        and then F = Data_Frame (Identifier (I), Base, 2, 16#0101#);
   end loop;
   Facts.Check ("frames come back whole and in order", Right);
   Ravenchart.Epochs.Since_Start (Before);
   Nodes.Send (Data_Frame (7, Base, 0, 0), Status);
   Await (51);
   Ravenchart.Epochs.Since_Start (After);
   Nodes.Wait_Frame (F, Stamp);
   Facts.Check
     ("a frame bears the time at which it came, not that of its taking",
      F.Id = 7 and then Before > 0 and then Stamp in Before .. After);
   Nodes.Send (Remote_Frame (5, Extended, 0), Status);
   Right := Status = Queued;
   Nodes.Send (Remote_Frame (16#100#, Extended, 0), Status);
   Right := Right and then Status = Queued;
   Nodes.Wait_Frame (F, Stamp);
   Facts.Check
     ("the filter refuses what it does not accept",
      Right and then F.Id = 16#100#);
   Right := True;
   for Code in Length_Code loop
      Long := Fd_Data_Frame
        (16#20#, Base, Length_Of (Code),
         Words => (0 .. 6 => 16#0102_0304_0506_0708#, 7 => 1),
         Rate  => Switched_Rate);
      Nodes.Node.Send (Any_Frames.To_Any (Long), Status);
      Right := Right and then Status = Queued;
      Nodes.Send (Data_Frame (16#21#, Base, 1, 5), Status);
      Nodes.Node.Wait_Frame (Any, Stamp);
      Right := Right and then Any = Any_Frames.To_Any (Long);
      Nodes.Wait_Frame (F, Stamp);
      Right := Right and then F = Data_Frame (16#21#, Base, 1, 5);
   end loop;
   Facts.Check
     ("CAN FD frames of every length come back, in order with others", Right);
   Right := True;
   for I in 1 .. 20_000 loop
      Nodes.Send
        (Data_Frame (Identifier (I mod 256), Base, 0, 0), Status);
      Nodes.Wait_Frame (F, Stamp);
      Right := Right and then F.Id = Identifier (I mod 256);
   end loop;
   Facts.Check ("no wake-up is lost in twenty thousand", Right);
   for I in 1 .. 120 loop
      Nodes.Send (Data_Frame (1, Base, 0, 0), Status);
   end loop;
   Await (20_204);
   Nodes.Node.Read_Counters (Count);
   Facts.Check
     ("everything is counted",
      Count.Sent = 20_205
      and then Count.Received = 20_204
      and then Count.Lost_In = 20
      and then Count.Lost_Out = 0);
   Facts.Finish;
end Test_Controller;
