--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The driver of CAN0 against a peer, which is the registers of CAN1. One line
--  for each fact.

with Ada.Real_Time;
with GNAT.IO;
with Interfaces;
with Ravenchart.Boards;
with Ravenchart.Can;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Xcan_Cores;
with Ravenchart.Can.Xcan_Frames;
with Ravenchart.Can.Xcan_Registers;
with Ravenchart.Epochs;
with Driven;

procedure Can_Driver is
   use type Ada.Real_Time.Time;
   use type Interfaces.Unsigned_32;
   use type Ravenchart.Can.Controller_State;
   use type Ravenchart.Can.Identifier;
   use type Ravenchart.Can.Send_Status;
   use type Ravenchart.Event_Count;

   package Registers renames Ravenchart.Can.Xcan_Registers;
   package Frames renames Ravenchart.Can.Xcan_Frames;
   package Peer is new Ravenchart.Can.Xcan_Cores (16#FF07_0000#);

   All_Hold : Boolean := True;
   Now      : Ada.Real_Time.Time := Ravenchart.Epochs.Start;

   procedure Check (Fact : String; Holds : Boolean);

   procedure Pass (Milliseconds : Positive);

   function Sample (Number : Natural) return Ravenchart.Can.Frame;
   --  A frame whose identifier is Number.

   function Same (Left, Right : Ravenchart.Can.Frame) return Boolean;

   procedure Read (F : out Ravenchart.Can.Frame; Found : out Boolean);
   --  What the peer has received.

   -----------
   -- Check --
   -----------

   procedure Check (Fact : String; Holds : Boolean) is
   begin
      GNAT.IO.Put_Line ((if Holds then "ok " else "not ok ") & Fact);
      All_Hold := All_Hold and then Holds;
   end Check;

   ----------
   -- Pass --
   ----------

   procedure Pass (Milliseconds : Positive) is
   begin
      Now := Now + Ada.Real_Time.Milliseconds (Milliseconds);
      delay until Now;
   end Pass;

   ------------
   -- Sample --
   ------------

   function Sample (Number : Natural) return Ravenchart.Can.Frame is
      use type Interfaces.Unsigned_64;
   begin
      return Ravenchart.Can.Data_Frame
        (Ravenchart.Can.Identifier (Number),
         Ravenchart.Can.Standard,
         8,
         16#0807_0605_0403_0201# + Interfaces.Unsigned_64 (Number));
   end Sample;

   ----------
   -- Same --
   ----------

   function Same (Left, Right : Ravenchart.Can.Frame) return Boolean is
      use type Interfaces.Unsigned_64;
   begin
      return Left.Id = Right.Id
        and then Ravenchart.Can.Payload (Left)
                 = Ravenchart.Can.Payload (Right);
   end Same;

   ----------
   -- Read --
   ----------

   procedure Read (F : out Ravenchart.Can.Frame; Found : out Boolean) is
      Causes : Registers.Word;
      Item   : Frames.Image;
   begin
      Peer.Write (Registers.Icr, Registers.Receive_Not_Empty);
      Peer.Read (Registers.Isr, Causes);
      Found := (Causes and Registers.Receive_Not_Empty) /= 0;
      F     := Ravenchart.Can.Null_Frame;
      if Found then
         Peer.Read_Frame (Item);
         F := Frames.Frame_Of (Item);
      end if;
   end Read;

   Joined : Boolean;
   State  : Ravenchart.Can.Controller_State;
   Counts : Ravenchart.Can.Counters;
   Status : Ravenchart.Can.Send_Status;
   Item   : Ravenchart.Can.Frame;
   Found  : Boolean;
   Right  : Boolean := True;
   Sent   : Natural := 0;

begin
   Peer.Configure (100_000_000, 500_000, Joined);
   Pass (5);
   Driven.Controller.Read_State (State);
   Check
     ("the driver has joined the bus",
      Joined and then State = Ravenchart.Can.Error_Active);

   for Number in 1 .. 50 loop
      Driven.Controller.Send
        (Ravenchart.Can.Any_Frames.To_Any (Sample (Number)), Status);
      Right := Right and then Status = Ravenchart.Can.Queued;
   end loop;
   Pass (3);
   for Number in 1 .. 50 loop
      Read (Item, Found);
      Right := Right and then Found and then Same (Item, Sample (Number));
   end loop;
   Driven.Controller.Read_Counters (Counts);
   Check
     ("50 frames reach the peer in the order sent, and are counted",
      Right and then Counts.Sent = 50 and then Counts.Lost_Out = 0);

   for Number in 1 .. 40 loop
      Peer.Write_Frame (Frames.Image_Of (Sample (100 + Number)));
   end loop;
   Pass (5);
   Driven.Controller.Read_Counters (Counts);
   Check
     ("40 frames of the peer arrive in order",
      Driven.Taken.Count = 40
      and then Driven.Taken.In_Order
      and then Counts.Received = 40
      and then Counts.Lost_In = 0);

   for Number in 1 .. 80 loop
      Peer.Write_Frame (Frames.Image_Of (Sample (140 + Number)));
   end loop;
   Pass (5);
   Driven.Controller.Read_Counters (Counts);
   Check
     ("of 80 frames at once 64 are kept, and the loss is counted",
      Counts.Received = 104 and then Counts.Lost_In = 1);

   for Number in 1 .. 200 loop
      Driven.Controller.Send
        (Ravenchart.Can.Any_Frames.To_Any (Sample (Number)), Status);
      if Status = Ravenchart.Can.Queued then
         Sent := Sent + 1;
      end if;
   end loop;
   Pass (10);
   Driven.Controller.Read_Counters (Counts);
   Check
     ("a full queue rejects frames and counts them",
      Sent in 64 .. 199
      and then Counts.Lost_Out = Ravenchart.Event_Count (200 - Sent)
      and then Counts.Sent = 50 + Ravenchart.Event_Count (Sent));
   Ravenchart.Boards.Finish (All_Hold);
end Can_Driver;
