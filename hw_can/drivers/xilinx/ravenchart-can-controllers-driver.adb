--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Driver "xilinx": the CAN controller of Zynq-7000 and Zynq UltraScale+.
--
--  Guarantees   frames go to the bus in the order sent, whatever their
--               identifiers; a frame that does not fit is counted
--  Tasking      one task, which looks at the controller every millisecond
--  Timing       bounded: at each look at most Fifo_Depth frames are received
--               and as many sent
--  Assumptions  ASM-022, the controller is at the address in Xcan_Core
--
--  The receive FIFO holds the frames of 3 ms of a full bus of 1 Mbit/s. The
--  controller filters nothing, since Accepts does. It has no CAN FD.

with Ada.Real_Time;
with Ravenchart.Epochs;
with Ravenchart.Schedules;
with Ravenchart.Can.Xcan_Core;
with Ravenchart.Can.Xcan_Frames;
with Ravenchart.Can.Xcan_Registers;

separate (Ravenchart.Can.Controllers)
package body Driver is
   pragma Refined_State ((State => Poller));
   pragma Compile_Time_Error
     (Bus_Number /= 1, "the driver xilinx has the controller of one bus");

   use type Any_Frames.Frame_Family;
   use type Queueing.Take_Status;
   use type Xcan_Registers.Word;

   package Registers renames Xcan_Registers;

   Period : constant := 1_000_000;
   --  The time from one look to the next.

   Clock : constant := 100_000_000;
   --  The clock of the controller: CAN_REF_CLK.

   Nominal : constant Registers.Hertz := Registers.Hertz (Setting.Bit_Rate);

   subtype Look_Count is Natural range 0 .. 1_000_000;

   Recovery_Looks : constant Look_Count :=
     Look_Count (128 * 11 * 1_000 / Setting.Bit_Rate) + 2;
   --  The duration of 128 times eleven recessive bits (ISO 11898-1), and one
   --  look more.

   type Progress is record
      Configured : Boolean := False;
      Held       : Boolean := False;
      Wait       : Look_Count := 0;
      Pending    : Natural range 0 .. Registers.Fifo_Depth := 0;
   end record;
   --  Configured: the controller was configured. Held: it is in reset because
   --  it was bus-off. Wait: the looks for which it stays there, 0 before
   --  recovery is requested. Pending: the frames in the transmit FIFO when it
   --  was last filled.

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Poller
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Serves the controller.

   procedure Configure (P : in out Progress)
   with Global => (In_Out => Xcan_Core.Registers);
   --  Let the controller join the bus.

   procedure Note_Errors (P : in out Progress)
   with
     Global => (In_Out => (Xcan_Core.Registers, Upper.State, Upper.Wake_Up));
   --  Note the state and the counters. The controller leaves bus-off by
   --  itself. Where recovery needs a request, the driver holds it in reset,
   --  and the frames in its FIFO are lost.

   procedure Receive_Frames
   with
     Global =>
       (In_Out => (Xcan_Core.Registers, Upper.State, Upper.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  Receive the frames that have come.

   procedure Send_Frames (P : in out Progress)
   with
     Global => (In_Out => (Xcan_Core.Registers, Upper.State, Upper.Wake_Up));
   --  Fill the FIFO again when all its frames were sent.

   ---------------
   -- Configure --
   ---------------

   procedure Configure (P : in out Progress) is
   begin
      Xcan_Core.Configure (Clock, Nominal, P.Configured);
      P.Held := False;
      P.Wait := 0;
   end Configure;

   -----------------
   -- Note_Errors --
   -----------------

   procedure Note_Errors (P : in out Progress) is
      Status : Registers.Word;
      Count  : Registers.Word;
      State  : Controller_State;
      Wanted : Boolean;
   begin
      Upper.Take_Request (Wanted);
      if P.Held then
         if P.Wait = 1 then
            Configure (P);
         elsif P.Wait > 1 then
            P.Wait := P.Wait - 1;
         elsif Wanted then
            P.Wait := Recovery_Looks;
         end if;
         return;
      end if;
      Xcan_Core.Read (Registers.Sr, Status);
      Xcan_Core.Read (Registers.Ecr, Count);
      State := Registers.State_Of (Status);
      Upper.Note (State);
      Upper.Note_Errors
        (Transmit => Registers.Transmit_Errors (Count),
         Receive  => Registers.Receive_Errors (Count));
      if State = Bus_Off and then Setting.Recovery = On_Request then
         Xcan_Core.Write (Registers.Srr, Registers.Reset);
         Upper.Count (Upper.Lost_Out, By => Event_Count (P.Pending));
         P.Pending := 0;
         P.Held    := True;
      end if;
   end Note_Errors;

   --------------------
   -- Receive_Frames --
   --------------------

   procedure Receive_Frames is
      Causes : Registers.Word;
      Item   : Xcan_Frames.Image;
   begin
      for Nth in 1 .. Registers.Fifo_Depth loop
         --  The flag is set again while there is a frame.
         Xcan_Core.Write (Registers.Icr, Registers.Receive_Not_Empty);
         Xcan_Core.Read (Registers.Isr, Causes);
         exit when (Causes and Registers.Receive_Not_Empty) = 0;
         Xcan_Core.Read_Frame (Item);
         Upper.Receive (Any_Frames.To_Any (Xcan_Frames.Frame_Of (Item)));
      end loop;
      Xcan_Core.Read (Registers.Isr, Causes);
      if (Causes and Registers.Receive_Overflow) /= 0 then
         Upper.Count (Upper.Lost_In);
         Xcan_Core.Write (Registers.Icr, Registers.Receive_Overflow);
      end if;
   end Receive_Frames;

   -----------------
   -- Send_Frames --
   -----------------

   procedure Send_Frames (P : in out Progress) is
      Causes : Registers.Word;
      F      : Any_Frames.Any_Frame;
      Status : Queueing.Take_Status;
   begin
      Xcan_Core.Write (Registers.Icr, Registers.Transmit_Empty);
      Xcan_Core.Read (Registers.Isr, Causes);
      if (Causes and Registers.Transmit_Empty) /= 0 then
         if P.Pending > 0 then
            Upper.Count (Upper.Sent, By => Event_Count (P.Pending));
            P.Pending := 0;
         end if;
         for Nth in 1 .. Registers.Fifo_Depth loop
            Upper.Take_Queued (F, Status);
            exit when Status = Queueing.Empty;
            if F.Family = Any_Frames.Classic then
               Xcan_Core.Write_Frame (Xcan_Frames.Image_Of (F.Plain));
               P.Pending := Nth;
            else
               Upper.Count (Upper.Lost_Out);
            end if;
         end loop;
      end if;
   end Send_Frames;

   ------------
   -- Poller --
   ------------

   task body Poller is
      Last    : constant Event_Count := Schedules.Last_Release (0, Period);
      Release : Event_Count := 0;
      --  Wait for Start: a frame that came before the processors run would
      --  find no reader.
      P       : Progress;
   begin
      loop
         pragma Loop_Invariant (Release <= Last);
         delay until Epochs.Instant (Schedules.Due (0, Period, Release));
         if P.Configured then
            Note_Errors (P);
            if not P.Held then
               Receive_Frames;
               Send_Frames (P);
            end if;
         else
            Configure (P);
         end if;
         Release := Event_Count'Min (Next (Release), Last);
      end loop;
   end Poller;

end Driver;
