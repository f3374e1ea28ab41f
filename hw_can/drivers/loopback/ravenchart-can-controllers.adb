--  Driver "loopback": a bus inside the process, with this one node on it,
--  which receives what it sends.
--
--  Guarantees   frames come back in the order sent; none is corrupted; the
--               node is error-active, and never has to recover
--  Tasking      one task, the bus
--  Timing       a frame takes no time on the bus

with Ravenchart.Waiting_Queues;
with Ravenchart.Can.Received_Frames;

package body Ravenchart.Can.Controllers
  with
    SPARK_Mode,
    Refined_State =>
      (State   => (Transmit.State, Receive.State, Status_Board, Bus),
       Wake_Up => (Transmit.Wake_Up, Receive.Wake_Up, Asked))
is
   use type Queueing.Put_Status;

   package Transmit is new Waiting_Queues
     (Element_Type => Any_Frames.Any_Frame,
      Null_Element => Any_Frames.Null_Any_Frame,
      Capacity     => Transmit_Depth,
      Ceiling      => Transmit_Ceiling);

   package Receive is new Received_Frames
     (Capacity => Receive_Depth, Ceiling => Receive_Ceiling);

   protected Status_Board
     with Priority => Transmit_Ceiling
   is
      procedure Begin_Bus;

      procedure Count_Sent;

      procedure Count_Received;

      function Faults return Fault_Notices.Fault_Log;

      function All_Counts return Counters;

   private
      Log    : Fault_Notices.Fault_Log;
      Counts : Counters;
   end Status_Board;

   Asked : Boolean := False
   with Atomic;
   --  True when recovery was requested. It is never needed here.

   pragma Warnings
     (GNATprove, Off, "pragma ""Storage_Size"" ignored*",
      Reason => "ASM-004, stack use is not a matter of proof");

   task Bus
   with Priority => Driver_Priority, Storage_Size => Stack_Bytes;
   --  Carries each frame from the transmit queue to the receive queue.

   protected body Status_Board is

      procedure Begin_Bus is
      begin
         Log := Fault_Notices.Noted (Log, Error_Active);
      end Begin_Bus;

      procedure Count_Sent is
      begin
         Counts.Sent := Next (Counts.Sent);
      end Count_Sent;

      procedure Count_Received is
      begin
         Counts.Received := Next (Counts.Received);
      end Count_Received;

      function Faults return Fault_Notices.Fault_Log
      is (Log);

      function All_Counts return Counters
      is (Counts);

   end Status_Board;

   task body Bus is
      F : Any_Frames.Any_Frame;
   begin
      Status_Board.Begin_Bus;
      loop
         Transmit.Wait (F);
         Status_Board.Count_Sent;
         if Accepts (Any_Frames.Id (F), Any_Frames.Format (F)) then
            Status_Board.Count_Received;
            Receive.Put (F);
         end if;
      end loop;
   end Bus;

   procedure Send (F : Any_Frames.Any_Frame; Status : out Send_Status)
   with Refined_Global => (In_Out => (Transmit.State, Transmit.Wake_Up))
   is
      Result : Queueing.Put_Status;
   begin
      Transmit.Put (F, Result);
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
   with Refined_Global => Status_Board
   is
      Log : constant Fault_Notices.Fault_Log := Status_Board.Faults;
   begin
      Now := Log.State;
   end Read_State;

   procedure Read_Faults (Log : out Fault_Notices.Fault_Log)
   with Refined_Global => Status_Board
   is
   begin
      Log := Status_Board.Faults;
   end Read_Faults;

   procedure Request_Recovery
   with Refined_Global => (Output => Asked)
   is
   begin
      Asked := True;
   end Request_Recovery;

   procedure Read_Counters (C : out Counters)
   with
     Refined_Global => (Transmit.State, Receive.State, Status_Board)
   is
      Lost_Out : constant Event_Count := Transmit.Lost;
      Lost_In  : constant Event_Count := Receive.Lost;
   begin
      C          := Status_Board.All_Counts;
      C.Lost_Out := Lost_Out;
      C.Lost_In  := Lost_In;
   end Read_Counters;

end Ravenchart.Can.Controllers;
