--  Driver "ctucanfd": a CTU CAN FD core by its registers, without the kernel.
--
--  Guarantees   frames go to the bus in the order sent, whatever their
--               identifiers; what does not fit is counted
--  Tasking      one task, which looks at the core every millisecond
--  Timing       bounded: at each look at most Frames_At_Once frames are
--               received and four sent
--  Assumptions  ASM-013, the core is where Ctu_Hosts says
--
--  The core filters nothing, since Accepts does. It must have four transmit
--  buffers. When it goes, the state is Stopped and what is sent is lost; it
--  is looked for every second.

with Ada.Real_Time;
with Ravenchart.Blackboards;
with Ravenchart.Epochs;
with Ravenchart.Queues;
with Ravenchart.Can.Ctu_Core;
with Ravenchart.Can.Ctu_Frames;
with Ravenchart.Can.Ctu_Hosts;
with Ravenchart.Can.Ctu_Registers;
with Ravenchart.Can.Received_Frames;

package body Ravenchart.Can.Controllers
  with
    SPARK_Mode,
    Refined_State =>
      (State   => (Transmit.State, Receive.State, Board.State, Poller),
       Wake_Up => (Receive.Wake_Up, Asked, Recovery_Asked))
is
   use type Ada.Real_Time.Time;
   use type Ctu_Registers.Buffer_State;
   use type Queueing.Put_Status;
   use type Queueing.Take_Status;

   package Registers renames Ctu_Registers;

   Frames_At_Once : constant := 32;
   --  More than a bus of 1 Mbit/s brings in a millisecond: 21.

   Looks_A_Second : constant := 1_000;

   Nominal : constant Registers.Hertz := Registers.Hertz (Setting.Bit_Rate);

   Data_Rate : constant Registers.Hertz :=
     (if Setting.Data_Rate = 0
      then Nominal else Registers.Hertz (Setting.Data_Rate));

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

   type Phase is (Absent, In_Reset, Running);
   --  Of the core.

   subtype Look_Count is Natural range 0 .. Looks_A_Second;

   type Progress is record
      Core     : Phase := Absent;
      Retry_In : Look_Count := 0;
      Queued   : Boolean := False;
      Rescued  : Boolean := False;
      Oldest   : Registers.Buffer := 1;
      Pending  : Natural range 0 .. 4 := 0;
   end record;
   --  Looks until a core is looked for, or asked to recover, again; whether
   --  the transmit queue may hold a frame; whether recovery was requested
   --  since the core is bus-off; and the buffers that wait to be sent, from
   --  Oldest on.

   Asked : Boolean := False
   with Atomic;
   --  True when a frame was queued since the transmit queue was found empty;
   --  to look at this costs no lock.

   Recovery_Asked : Boolean := False
   with Atomic;
   --  True when recovery was requested since the core was last looked at.

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Poller
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Serves the core.

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

   procedure Give_Up (P : in out Progress; Counts : in out Counters)
   with Global => (In_Out => (Transmit.State, Asked));
   --  There is nothing to send to.

   procedure Look_For (P : in out Progress)
   with
     Global => (In_Out => (Ctu_Core.Registers, Ctu_Hosts.Console));
   --  Find the core, and reset it.

   procedure Configure (P : in out Progress)
   with
     Global => (In_Out => (Ctu_Core.Registers, Ctu_Hosts.Console));
   --  Give it its bit rates, and let it join the bus.

   procedure Note_Errors (S : in out Standing; P : in out Progress)
   with Global => (In_Out => (Ctu_Core.Registers, Recovery_Asked));
   --  How it stands; from bus-off, ask for recovery when the setting or a
   --  request says so. One that has just been enabled is off too, and is
   --  always asked: it needs no more than the bus to be idle.

   procedure Receive_Frames (Counts : in out Counters)
   with
     Global =>
       (In_Out => (Ctu_Core.Registers, Receive.State, Receive.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  Take what has come.

   procedure Send_Frames (P : in out Progress; Counts : in out Counters)
   with Global => (In_Out => (Ctu_Core.Registers, Transmit.State, Asked));
   --  See what was sent, and fill the buffers again.

   procedure Serve (S : in out Standing; P : in out Progress)
   with
     Global =>
       (In_Out => (Ctu_Core.Registers, Transmit.State, Asked,
                   Recovery_Asked, Receive.State, Receive.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  One look at a core that runs.

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

   -------------
   -- Give_Up --
   -------------

   procedure Give_Up (P : in out Progress; Counts : in out Counters) is
      F      : Any_Frames.Any_Frame;
      Status : Queueing.Take_Status;
   begin
      for Nth in 1 .. Transmit_Depth loop
         pragma Warnings
           (GNATprove, Off, """F"" is set by*", Reason => "it is lost");
         Take_Queued (F, P, Status);
         pragma Warnings (GNATprove, On, """F"" is set by*");
         exit when Status = Queueing.Empty;
         Counts.Lost_Out := Next (Counts.Lost_Out);
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
         P := (Core => In_Reset, Queued => P.Queued, others => <>);
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

   procedure Note_Errors (S : in out Standing; P : in out Progress) is
      Fault  : Registers.Word;
      Count  : Registers.Word;
      Wanted : constant Boolean := Recovery_Asked;
   begin
      if Wanted then
         Recovery_Asked := False;
      end if;
      P.Rescued :=
        S.Log.State = Bus_Off and then (Wanted or else P.Rescued);
      Ctu_Core.Read (Registers.Fault_State, Fault);
      Ctu_Core.Read (Registers.Rec_Tec, Count);
      S.Log :=
        Fault_Notices.Noted
          (S.Log, Registers.State_Of (Fault, Before => S.Log.State));
      S.Counts.Receive_Errors  := Registers.Receive_Errors (Count);
      S.Counts.Transmit_Errors := Registers.Transmit_Errors (Count);
      if not Registers.Is_Off (Fault) then
         P.Retry_In := 0;
      elsif Setting.Recovery = On_Request
        and then S.Log.State = Bus_Off
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

   procedure Receive_Frames (Counts : in out Counters) is
      State : Registers.Word;
      Item  : Ctu_Frames.Image;
      F     : Any_Frames.Any_Frame;
   begin
      for Nth in 1 .. Frames_At_Once loop
         Ctu_Core.Read (Registers.Rx_Status_Settings, State);
         exit when Registers.Frames_Waiting (State) = 0;
         Ctu_Core.Read_Frame (Item);
         F := Ctu_Frames.Any_Frame_Of (Item);
         if Any_Frames.Fits (F, Setting)
           and then Accepts (Any_Frames.Id (F), Any_Frames.Format (F))
         then
            Counts.Received := Next (Counts.Received);
            Receive.Put (F);
         end if;
      end loop;
      Ctu_Core.Read (Registers.Status, State);
      if Registers.Is_Overrun (State) then
         Counts.Lost_In := Next (Counts.Lost_In);
         Ctu_Core.Write (Registers.Command, Registers.Clear_Overrun);
      end if;
   end Receive_Frames;

   -----------------
   -- Send_Frames --
   -----------------

   procedure Send_Frames (P : in out Progress; Counts : in out Counters) is
      Buffers : Registers.Word;
      Slot    : Registers.Buffer;
      F       : Any_Frames.Any_Frame;
      Status  : Queueing.Take_Status;
   begin
      Ctu_Core.Read (Registers.Tx_Status, Buffers);
      for Nth in Registers.Buffer loop
         exit when P.Pending = 0
           or else not Registers.Is_Done (Buffers, P.Oldest);
         if Registers.State_Of (Buffers, P.Oldest) = Registers.Sent then
            Counts.Sent := Next (Counts.Sent);
         else
            Counts.Lost_Out := Next (Counts.Lost_Out);
         end if;
         P.Oldest  := Registers.Next (P.Oldest);
         P.Pending := P.Pending - 1;
      end loop;
      Ctu_Core.Write
        (Registers.Tx_Priority, Registers.Priorities (P.Oldest));
      Slot := P.Oldest;
      for Nth in Registers.Buffer loop
         if Natural (Nth) > P.Pending then
            Take_Queued (F, P, Status);
            exit when Status = Queueing.Empty;
            Ctu_Core.Write_Frame (Slot, Ctu_Frames.Image_Of (F));
            Ctu_Core.Write
              (Registers.Tx_Command, Registers.Set_Ready (Slot));
            P.Pending := Natural (Nth);
         end if;
         Slot := Registers.Next (Slot);
      end loop;
   end Send_Frames;

   -----------
   -- Serve --
   -----------

   procedure Serve (S : in out Standing; P : in out Progress) is
      Id : Registers.Word;
   begin
      Ctu_Core.Read (Registers.Device_Id_Version, Id);
      if Registers.Is_Core (Id) then
         Note_Errors (S, P);
         Receive_Frames (S.Counts);
         Send_Frames (P, S.Counts);
      else
         S.Log             := Fault_Notices.Noted (S.Log, Stopped);
         S.Counts.Lost_Out :=
           Sum (S.Counts.Lost_Out, Event_Count (P.Pending));
         P                 := (Queued => P.Queued, others => <>);
      end if;
   end Serve;

   ------------
   -- Poller --
   ------------

   task body Poller is
      Due : Ada.Real_Time.Time := Epochs.Start;
      --  Frames that come before the processors run would find nobody.
      P   : Progress;
      S   : Standing;
   begin
      loop
         delay until Due;
         case P.Core is
            when Absent =>
               Give_Up (P, S.Counts);
               if P.Retry_In = 0 then
                  Look_For (P);
               else
                  P.Retry_In := P.Retry_In - 1;
               end if;
            when In_Reset =>
               Configure (P);
            when Running =>
               Serve (S, P);
         end case;
         Board.Write (S);
         Due := Due + Ada.Real_Time.Milliseconds (1);
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
