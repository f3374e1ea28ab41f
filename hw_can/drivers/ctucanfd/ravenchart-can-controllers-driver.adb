--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Driver "ctucanfd": a CTU CAN FD core by its registers, without the kernel.
--
--  Guarantees   frames go to the bus in the order sent, or by priority where
--               Transmit_Orders says so; a frame that does not fit is counted
--  Tasking      a task that serves the core, when a frame was sent and every
--               millisecond, for which another task wakes it
--  Timing       bounded: at most Frames_At_Once frames are received each
--               millisecond, and four sent at once
--  Assumptions  ASM-013, the core is where Ctu_Hosts puts it
--
--  The core filters nothing, since Accepts does. It must have four transmit
--  buffers. A frame that was sent gets a free one at once. Before each attempt
--  the core selects the buffer of the highest priority anew. By priority no
--  frame waits for a less urgent one of its node that has not begun, as long
--  as four frames at most wait. When the core disappears, the state is Stopped
--  and sent frames are lost; the driver looks for it every second.

with Ada.Real_Time;
with Ravenchart.Epochs;
with Ravenchart.Can.Arbitration;
with Ravenchart.Can.Ctu_Buffers;
with Ravenchart.Can.Ctu_Core;
with Ravenchart.Can.Ctu_Frames;
with Ravenchart.Can.Ctu_Hosts;
with Ravenchart.Can.Ctu_Registers;
with Ravenchart.Can.Transmit_Orders;

separate (Ravenchart.Can.Controllers)
package body Driver is
   pragma Refined_State ((State => (Is_Due, Ticker, Server)));
   pragma Compile_Time_Error
     (Bus_Number /= 1, "the driver ctucanfd has the controller of one bus");

   use type Ada.Real_Time.Time;
   use type Ctu_Registers.Buffer_State;
   use type Queueing.Take_Status;

   package Registers renames Ctu_Registers;

   Frames_At_Once : constant := 32;
   --  More than the 21 frames that a bus of 1 Mbit/s carries in a millisecond.

   Looks_A_Second : constant := 1_000;

   Is_Due : Boolean := False
   with Atomic;
   --  True when a millisecond has passed since the last look.

   Nominal : constant Registers.Hertz := Registers.Hertz (Setting.Bit_Rate);

   Data_Rate : constant Registers.Hertz :=
     (if Setting.Data_Rate = 0
      then Nominal else Registers.Hertz (Setting.Data_Rate));

   type Phase is (Absent, In_Reset, Running);
   --  The phase of the core.

   subtype Look_Count is Natural range 0 .. Looks_A_Second;

   type Progress is record
      Core     : Phase := Absent;
      Retry_In : Look_Count := 0;
      State    : Controller_State := Stopped;
      Rescued  : Boolean := False;
      Buffers  : Ctu_Buffers.Line;
   end record;
   --  Retry_In: looks until the next search for a core, or the next request
   --  for recovery. State: the state of the core at the last look. Rescued:
   --  recovery was requested since bus-off. Buffers: the frames in the core.

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Ticker
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Wakes the server every millisecond.

   task Server
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Serves the core.

   procedure Give_Up
   with Global => (In_Out => (Upper.State, Upper.Wake_Up));
   --  Stop: there is no core to send to.

   procedure Look_For (P : in out Progress)
   with
     Global => (In_Out => (Ctu_Core.Registers, Ctu_Hosts.Console));
   --  Find the core, and reset it.

   procedure Configure (P : in out Progress)
   with
     Global => (In_Out => (Ctu_Core.Registers, Ctu_Hosts.Console));
   --  Set the bit rates of the core, and let it join the bus.

   procedure Note_Errors (P : in out Progress)
   with
     Global => (In_Out => (Ctu_Core.Registers, Upper.State, Upper.Wake_Up));
   --  Note the state and the counters. From bus-off, request recovery when the
   --  setting or the program does. A core that has just been enabled is off
   --  too, and recovery is always requested: it needs only an idle bus.

   procedure Receive_Frames
   with
     Global =>
       (In_Out => (Ctu_Core.Registers, Upper.State, Upper.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  Receive the frames that have come.

   procedure Note_Sent (P : in out Progress)
   with Global => (In_Out => (Ctu_Core.Registers, Upper.State));
   --  Note the frames that were sent.

   procedure Send_Frames (P : in out Progress)
   with
     Global =>
       (In_Out => (Ctu_Core.Registers, Upper.State, Upper.Wake_Up),
        Input  => Transmit_Orders.State);
   --  Fill the free buffers.

   procedure Serve (P : in out Progress; Looks : Boolean)
   with
     Global =>
       (In_Out => (Ctu_Core.Registers, Upper.State, Upper.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time,
                   Transmit_Orders.State));
   --  Send what waits on a core that runs. Looks: see to its state and to the
   --  frames that have come, too.

   procedure Look (P : in out Progress)
   with
     Global =>
       (In_Out => (Ctu_Core.Registers, Ctu_Hosts.Console, Upper.State,
                   Upper.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time,
                   Transmit_Orders.State));
   --  The work of every millisecond.

   -------------
   -- Give_Up --
   -------------

   procedure Give_Up is
      F      : Any_Frames.Any_Frame;
      Status : Queueing.Take_Status;
   begin
      for Nth in 1 .. Transmit_Depth loop
         pragma Warnings
           (GNATprove, Off, """F"" is set by*", Reason => "it is lost");
         Upper.Take_Queued (F, Status);
         pragma Warnings (GNATprove, On, """F"" is set by*");
         exit when Status = Queueing.Empty;
         Upper.Count (Upper.Lost_Out);
      end loop;
   end Give_Up;

   --------------
   -- Look_For --
   --------------

   procedure Look_For (P : in out Progress) is
      Opened  : Boolean;
      Id      : Registers.Word;
      Buffers : Registers.Word;
   begin
      Ctu_Core.Open (Opened);
      Ctu_Core.Read (Registers.Device_Id_Version, Id);
      Ctu_Core.Read (Registers.Tx_Status, Buffers);
      if not Opened then
         Ctu_Hosts.Complain (Ctu_Hosts.No_Device);
      elsif not Registers.Is_Core (Id)
        or else not Registers.Has_Buffers (Buffers)
      then
         Ctu_Hosts.Complain (Ctu_Hosts.No_Core);
      else
         Ctu_Core.Write (Registers.Mode_Settings, Registers.Reset);
         P := (Core => In_Reset, State => P.State, others => <>);
         return;
      end if;
      P.Retry_In := Looks_A_Second;
   end Look_For;

   ---------------
   -- Configure --
   ---------------

   procedure Configure (P : in out Progress) is
      Clock  : constant Registers.Hertz := Ctu_Hosts.Clock;
      Timing : Registers.Bit_Timing;
      Data   : Registers.Bit_Timing;
      Found  : Boolean;
      Other  : Boolean;
   begin
      Registers.Choose_Timing
        (Clock, Nominal, Registers.Quanta_Count'Last, Timing, Found);
      Registers.Choose_Timing
        (Clock, Data_Rate, Registers.Data_Quanta, Data, Other);
      if Found and then (Other or else not Setting.Takes_Fd) then
         Ctu_Core.Write (Registers.Btr, Registers.Btr_Of (Timing));
         if Setting.Takes_Fd then
            Ctu_Core.Write (Registers.Btr_Fd, Registers.Btr_Of (Data));
            Ctu_Core.Write
              (Registers.Trv_Delay, Registers.Ssp_Of (Data, Data_Rate));
         end if;
         Ctu_Core.Write
           (Registers.Mode_Settings,
            (if Setting.Takes_Fd
             then Registers.Fd_Mode else Registers.Classic_Mode));
         Ctu_Hosts.Announce;
         P.Core := Running;
      else
         Ctu_Hosts.Complain (Ctu_Hosts.No_Bit_Rate);
         P.Core := Absent;
      end if;
      P.Retry_In := Looks_A_Second;
   end Configure;

   -----------------
   -- Note_Errors --
   -----------------

   procedure Note_Errors (P : in out Progress) is
      Fault  : Registers.Word;
      Count  : Registers.Word;
      Wanted : Boolean;
   begin
      Upper.Take_Request (Wanted);
      P.Rescued := P.State = Bus_Off and then (Wanted or else P.Rescued);
      Ctu_Core.Read (Registers.Fault_State, Fault);
      Ctu_Core.Read (Registers.Rec_Tec, Count);
      P.State := Registers.State_Of (Fault, Before => P.State);
      Upper.Note (P.State);
      Upper.Note_Errors
        (Transmit => Registers.Transmit_Errors (Count),
         Receive  => Registers.Receive_Errors (Count));
      if not Registers.Is_Off (Fault) then
         P.Retry_In := 0;
      elsif Setting.Recovery = On_Request
        and then P.State = Bus_Off
        and then not P.Rescued
      then
         P.Retry_In := 0;
      elsif P.Retry_In = 0 then
         Ctu_Core.Write (Registers.Command, Registers.Recover);
         P.Retry_In := Looks_A_Second;
      else
         P.Retry_In := P.Retry_In - 1;
      end if;
   end Note_Errors;

   --------------------
   -- Receive_Frames --
   --------------------

   procedure Receive_Frames is
      State : Registers.Word;
      Item  : Ctu_Frames.Image;
   begin
      for Nth in 1 .. Frames_At_Once loop
         Ctu_Core.Read (Registers.Rx_Status_Settings, State);
         exit when Registers.Frames_Waiting (State) = 0;
         Ctu_Core.Read_Frame (Item);
         Upper.Receive (Ctu_Frames.Any_Frame_Of (Item));
      end loop;
      Ctu_Core.Read (Registers.Status, State);
      if Registers.Is_Overrun (State) then
         Upper.Count (Upper.Lost_In);
         Ctu_Core.Write (Registers.Command, Registers.Clear_Overrun);
      end if;
   end Receive_Frames;

   ---------------
   -- Note_Sent --
   ---------------

   procedure Note_Sent (P : in out Progress) is
      States : Registers.Word;
      Nth    : Positive := 1;
      Slot   : Registers.Buffer;
   begin
      Ctu_Core.Read (Registers.Tx_Status, States);
      for Unused in Ctu_Buffers.Place loop
         exit when Nth > P.Buffers.Waiting;
         Slot := P.Buffers.Buffers (Nth);
         if Registers.Is_Done (States, Slot) then
            if Registers.State_Of (States, Slot) = Registers.Sent then
               Upper.Count (Upper.Sent);
            else
               Upper.Count (Upper.Lost_Out);
            end if;
            Ctu_Buffers.Remove (P.Buffers, Nth);
         else
            Nth := Nth + 1;
         end if;
      end loop;
   end Note_Sent;

   -----------------
   -- Send_Frames --
   -----------------

   procedure Send_Frames (P : in out Progress) is
      F       : Any_Frames.Any_Frame;
      Status  : Queueing.Take_Status;
      Ordered : Boolean;
      Rank    : Arbitration.Rank;
      Slot    : Registers.Buffer;
   begin
      for Nth in Ctu_Buffers.Place loop
         exit when P.Buffers.Waiting = Ctu_Buffers.Room;
         Upper.Take_Queued (F, Status);
         exit when Status = Queueing.Empty;
         Transmit_Orders.Read (Bus_Number, Ordered);
         Rank := (if Ordered then Ctu_Buffers.Urgency (F) else 0);
         Ctu_Buffers.Put (P.Buffers, Rank, Slot);
         Ctu_Core.Write_Frame (Slot, Ctu_Frames.Image_Of (F));
         Ctu_Core.Write
           (Registers.Tx_Priority, Ctu_Buffers.Priorities (P.Buffers));
         --  Those that are ready keep their order.
         Ctu_Core.Write (Registers.Tx_Command, Registers.Set_Ready (Slot));
      end loop;
   end Send_Frames;

   -----------
   -- Serve --
   -----------

   procedure Serve (P : in out Progress; Looks : Boolean) is
      Id : Registers.Word;
   begin
      Ctu_Core.Read (Registers.Device_Id_Version, Id);
      if Registers.Is_Core (Id) then
         if Looks then
            Note_Errors (P);
            Receive_Frames;
         end if;
         Note_Sent (P);
         Send_Frames (P);
      else
         Upper.Note (Stopped);
         Upper.Count
           (Upper.Lost_Out, By => Event_Count (P.Buffers.Waiting));
         P := (others => <>);
      end if;
   end Serve;

   ----------
   -- Look --
   ----------

   procedure Look (P : in out Progress) is
   begin
      case P.Core is
         when Absent =>
            Give_Up;
            if P.Retry_In = 0 then
               Look_For (P);
            else
               P.Retry_In := P.Retry_In - 1;
            end if;
         when In_Reset =>
            Configure (P);
         when Running =>
            Serve (P, Looks => True);
      end case;
   end Look;

   ------------
   -- Ticker --
   ------------

   task body Ticker is
      Due : Ada.Real_Time.Time := Epochs.Start;
      --  Wait for Start: a frame that came before the processors run would
      --  find no reader.
   begin
      loop
         delay until Due;
         Is_Due := True;
         Upper.Wake;
         Due := Due + Ada.Real_Time.Milliseconds (1);
      end loop;
   end Ticker;

   ------------
   -- Server --
   ------------

   task body Server is
      P     : Progress;
      Looks : Boolean;
   begin
      loop
         Upper.Wait_Work;
         Looks := Is_Due;
         if Looks then
            Is_Due := False;
            Look (P);
         elsif P.Core = Running then
            Serve (P, Looks => False);
         end if;
      end loop;
   end Server;

end Driver;
