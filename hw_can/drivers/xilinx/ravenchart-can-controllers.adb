--  Driver "xilinx": the CAN controller of Zynq-7000 and Zynq UltraScale+.
--
--  Guarantees   frames go to the bus in the order sent, whatever their
--               identifiers; what does not fit is counted
--  Tasking      one task, which looks at the controller every millisecond
--  Timing       bounded: at each look at most Fifo_Depth frames are received
--               and as many sent
--  Assumptions  ASM-022, the controller is where Xcan_Core says
--
--  The receive FIFO holds what a full bus of 1 Mbit/s brings in 3 ms. The
--  controller filters nothing, since Accepts does. It has no CAN FD.

with Ada.Real_Time;
with Ravenchart.Blackboards;
with Ravenchart.Epochs;
with Ravenchart.Queues;
with Ravenchart.Schedules;
with Ravenchart.Can.Received_Frames;
with Ravenchart.Can.Xcan_Core;
with Ravenchart.Can.Xcan_Frames;
with Ravenchart.Can.Xcan_Registers;

package body Ravenchart.Can.Controllers
  with
    SPARK_Mode,
    Refined_State =>
      (State   => (Transmit.State, Receive.State, Board.State, Poller),
       Wake_Up => (Receive.Wake_Up, Asked, Recovery_Asked))
is
   use type Any_Frames.Frame_Family;
   use type Queueing.Put_Status;
   use type Queueing.Take_Status;
   use type Xcan_Registers.Word;

   package Registers renames Xcan_Registers;

   Period : constant := 1_000_000;
   --  From one look to the next.

   Clock : constant := 100_000_000;
   --  That of the controller: CAN_REF_CLK.

   Nominal : constant Registers.Hertz := Registers.Hertz (Setting.Bit_Rate);

   package Transmit is new Queues
     (Element_Type => Any_Frames.Any_Frame,
      Null_Element => Any_Frames.Null_Any_Frame,
      Capacity     => Transmit_Depth,
      Ceiling      => Transmit_Ceiling,
      Policy       => Queueing.Reject_Newest);

   package Receive is new Received_Frames
     (Capacity => Receive_Depth, Ceiling => Receive_Ceiling);

   type Standing is record
      Log    : Fault_Notices.Fault_Log;
      Counts : Counters;
   end record;
   --  What others are told.

   Initially : constant Standing := (others => <>);

   package Board is new Blackboards
     (Element_Type => Standing,
      Initial      => Initially,
      Ceiling      => Transmit_Ceiling);

   subtype Look_Count is Natural range 0 .. 1_000_000;

   Recovery_Looks : constant Look_Count :=
     Look_Count (128 * 11 * 1_000 / Setting.Bit_Rate) + 2;
   --  As long as 128 times eleven recessive bits (ISO 11898-1), and one look
   --  more.

   type Progress is record
      Configured : Boolean := False;
      Held       : Boolean := False;
      Wait       : Look_Count := 0;
      Queued     : Boolean := False;
      Pending    : Natural range 0 .. Registers.Fifo_Depth := 0;
   end record;
   --  Whether the controller was configured; whether it is in reset because
   --  it was bus-off, and for how many looks yet, 0 before recovery is
   --  requested; whether the transmit queue may hold a frame; and the frames
   --  in the transmit FIFO when it was last filled.

   Asked : Boolean := False
   with Atomic;
   --  True when a frame was queued since the transmit queue was found empty;
   --  to look at this costs no lock.

   Recovery_Asked : Boolean := False
   with Atomic;
   --  True when recovery was requested since the last look.

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Poller
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Serves the controller.

   function Sum (A, B : Event_Count) return Event_Count
   is (if A > Event_Count'Last - B then Event_Count'Last else A + B)
   with Global => null;
   --  No more than the last value.

   procedure Take_Queued
     (F      : out Any_Frames.Any_Frame;
      P      : in out Progress;
      Status : out Queueing.Take_Status)
   with Global => (In_Out => (Transmit.State, Asked));
   --  The oldest frame of the transmit queue, if there is one.

   procedure Configure (P : in out Progress)
   with Global => (In_Out => Xcan_Core.Registers);
   --  Let the controller join the bus.

   procedure Note_Errors (S : in out Standing; P : in out Progress)
   with Global => (In_Out => (Xcan_Core.Registers, Recovery_Asked));
   --  How it stands. From bus-off it comes back by itself; where that needs a
   --  request it is held in reset, and what is in its FIFO is lost.

   procedure Receive_Frames (Counts : in out Counters)
   with
     Global =>
       (In_Out => (Xcan_Core.Registers, Receive.State, Receive.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  Take what has come.

   procedure Send_Frames (P : in out Progress; Counts : in out Counters)
   with Global => (In_Out => (Xcan_Core.Registers, Transmit.State, Asked));
   --  Where all was sent, fill the FIFO again.

   -----------------
   -- Take_Queued --
   -----------------

   procedure Take_Queued
     (F      : out Any_Frames.Any_Frame;
      P      : in out Progress;
      Status : out Queueing.Take_Status)
   is
      Is_Asked : constant Boolean := Asked;
   begin
      if Is_Asked then
         Asked    := False;
         P.Queued := True;
      end if;
      if P.Queued then
         Transmit.Take (F, Status);
         P.Queued := Status = Queueing.Taken;
      else
         F      := Any_Frames.Null_Any_Frame;
         Status := Queueing.Empty;
      end if;
   end Take_Queued;

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

   procedure Note_Errors (S : in out Standing; P : in out Progress) is
      Status : Registers.Word;
      Count  : Registers.Word;
      Wanted : constant Boolean := Recovery_Asked;
   begin
      if Wanted then
         Recovery_Asked := False;
      end if;
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
      S.Log := Fault_Notices.Noted (S.Log, Registers.State_Of (Status));
      S.Counts.Receive_Errors  := Registers.Receive_Errors (Count);
      S.Counts.Transmit_Errors := Registers.Transmit_Errors (Count);
      if S.Log.State = Bus_Off and then Setting.Recovery = On_Request then
         Xcan_Core.Write (Registers.Srr, Registers.Reset);
         S.Counts.Lost_Out :=
           Sum (S.Counts.Lost_Out, Event_Count (P.Pending));
         P.Pending := 0;
         P.Held    := True;
      end if;
   end Note_Errors;

   --------------------
   -- Receive_Frames --
   --------------------

   procedure Receive_Frames (Counts : in out Counters) is
      Causes : Registers.Word;
      Item   : Xcan_Frames.Image;
      F      : Frame;
   begin
      for Nth in 1 .. Registers.Fifo_Depth loop
         --  The cause comes again as long as there is a frame.
         Xcan_Core.Write (Registers.Icr, Registers.Receive_Not_Empty);
         Xcan_Core.Read (Registers.Isr, Causes);
         exit when (Causes and Registers.Receive_Not_Empty) = 0;
         Xcan_Core.Read_Frame (Item);
         F := Xcan_Frames.Frame_Of (Item);
         if Accepts (F.Id, F.Format) then
            Counts.Received := Next (Counts.Received);
            Receive.Put (Any_Frames.To_Any (F));
         end if;
      end loop;
      Xcan_Core.Read (Registers.Isr, Causes);
      if (Causes and Registers.Receive_Overflow) /= 0 then
         Counts.Lost_In := Next (Counts.Lost_In);
         Xcan_Core.Write (Registers.Icr, Registers.Receive_Overflow);
      end if;
   end Receive_Frames;

   -----------------
   -- Send_Frames --
   -----------------

   procedure Send_Frames (P : in out Progress; Counts : in out Counters) is
      Causes : Registers.Word;
      F      : Any_Frames.Any_Frame;
      Status : Queueing.Take_Status;
   begin
      Xcan_Core.Write (Registers.Icr, Registers.Transmit_Empty);
      Xcan_Core.Read (Registers.Isr, Causes);
      if (Causes and Registers.Transmit_Empty) /= 0 then
         Counts.Sent := Sum (Counts.Sent, Event_Count (P.Pending));
         P.Pending   := 0;
         for Nth in 1 .. Registers.Fifo_Depth loop
            Take_Queued (F, P, Status);
            exit when Status = Queueing.Empty;
            if F.Family = Any_Frames.Classic then
               Xcan_Core.Write_Frame (Xcan_Frames.Image_Of (F.Plain));
               P.Pending := Nth;
            else
               Counts.Lost_Out := Next (Counts.Lost_Out);
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
      --  Frames that come before the processors run would find nobody.
      P       : Progress;
      S       : Standing;
   begin
      loop
         pragma Loop_Invariant (Release <= Last);
         delay until Epochs.Instant (Schedules.Due (0, Period, Release));
         if P.Configured then
            Note_Errors (S, P);
            if not P.Held then
               Receive_Frames (S.Counts);
               Send_Frames (P, S.Counts);
            end if;
         else
            Configure (P);
         end if;
         Board.Write (S);
         Release := Event_Count'Min (Next (Release), Last);
      end loop;
   end Poller;

   procedure Send (F : Any_Frames.Any_Frame; Status : out Send_Status)
   with Refined_Global => (In_Out => Transmit.State, Output => Asked)
   is
      Result : Queueing.Put_Status;
   begin
      Transmit.Put (F, Result);
      Asked  := True;
      Status :=
        (if Result = Queueing.Rejected_Full then Rejected_Full else Queued);
   end Send;

   procedure Wait_Frame
     (F : out Any_Frames.Any_Frame; Stamp : out Nanoseconds)
   with Refined_Global => (In_Out => (Receive.State, Receive.Wake_Up))
   is
   begin
      Receive.Wait (F, Stamp);
   end Wait_Frame;

   procedure Read_State (Now : out Controller_State)
   with Refined_Global => Board.State
   is
      S : Standing;
   begin
      Board.Read (S);
      Now := S.Log.State;
   end Read_State;

   procedure Read_Faults (Log : out Fault_Notices.Fault_Log)
   with Refined_Global => Board.State
   is
      S : Standing;
   begin
      Board.Read (S);
      Log := S.Log;
   end Read_Faults;

   procedure Request_Recovery
   with Refined_Global => (Output => Recovery_Asked)
   is
   begin
      Recovery_Asked := True;
   end Request_Recovery;

   procedure Read_Counters (C : out Counters)
   with Refined_Global => (Transmit.State, Receive.State, Board.State)
   is
      Not_Queued : constant Event_Count := Transmit.Lost;
      Lost_In    : constant Event_Count := Receive.Lost;
      S          : Standing;
   begin
      Board.Read (S);
      C          := S.Counts;
      C.Lost_Out := Sum (C.Lost_Out, Not_Queued);
      C.Lost_In  := Sum (C.Lost_In, Lost_In);
   end Read_Counters;

end Ravenchart.Can.Controllers;
