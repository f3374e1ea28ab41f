--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Synchronous_Task_Control;
with Ravenchart.Queues;
with Ravenchart.Can.Received_Frames;

package body Ravenchart.Can.Upper_Halves
  with
    SPARK_Mode,
    Refined_State =>
      (State   => (Transmit.State, Received.State, Board),
       Wake_Up => (Received.Wake_Up, Is_Filled, Recovery_Asked, Work))
is
   pragma Warnings
     (GNATprove, Off, "no Always_Terminates aspect available*",
      Reason => "ASM-008, the library does not say it of suspension objects");
   pragma Warnings
     (GNATprove, Off, "assuming * always terminates",
      Reason => "ASM-008, the library does not say it of suspension objects");

   use Ada.Synchronous_Task_Control;
   use type Queueing.Put_Status;
   use type Queueing.Take_Status;

   package Transmit is new Queues
     (Element_Type => Any_Frames.Any_Frame,
      Null_Element => Any_Frames.Null_Any_Frame,
      Capacity     => Transmit_Depth,
      Ceiling      => Transmit_Ceiling,
      Policy       => Queueing.Reject_Newest);

   package Received is new Received_Frames
     (Capacity => Receive_Depth, Ceiling => Receive_Ceiling);

   protected Board
     with Priority => Transmit_Ceiling
   is
      procedure Note (Now : Controller_State);

      procedure Note_Traffic;

      procedure Note_Errors (Transmit, Receive : Error_Count);

      procedure Count (What : Counted; By : Event_Count);

      procedure Count_Received;

      function Faults return Fault_Notices.Fault_Log;

      function All_Counts return Counters;

   private
      Log    : Fault_Notices.Fault_Log;
      Counts : Counters;
   end Board;
   --  Written by the driver, read by the program.

   Is_Filled : Boolean := False
   with Atomic;
   --  True when a frame may have been queued since Take_Queued found none;
   --  reading it takes no lock.

   Recovery_Asked : Boolean := False
   with Atomic;
   --  True when recovery was requested since Take_Request.

   Work : Suspension_Object;
   --  True when there may be work since the caller of Wait_Work last looked.

   protected body Board is

      procedure Note (Now : Controller_State) is
      begin
         Log := Fault_Notices.Noted (Log, Now);
      end Note;

      procedure Note_Traffic is
      begin
         if Log.State = Stopped then
            Log := Fault_Notices.Noted (Log, Error_Active);
         end if;
      end Note_Traffic;

      procedure Note_Errors (Transmit, Receive : Error_Count) is
      begin
         Counts.Transmit_Errors := Transmit;
         Counts.Receive_Errors  := Receive;
      end Note_Errors;

      procedure Count (What : Counted; By : Event_Count) is
      begin
         case What is
            when Sent          =>
               Counts.Sent := Sum (Counts.Sent, By);
            when Lost_Out      =>
               Counts.Lost_Out := Sum (Counts.Lost_Out, By);
            when Lost_In       =>
               Counts.Lost_In := Sum (Counts.Lost_In, By);
            when Rejected_Line =>
               Counts.Rejected_Lines := Sum (Counts.Rejected_Lines, By);
         end case;
      end Count;

      procedure Count_Received is
      begin
         Counts.Received := Next (Counts.Received);
      end Count_Received;

      function Faults return Fault_Notices.Fault_Log
      is (Log);

      function All_Counts return Counters
      is (Counts);

   end Board;

   procedure Send (F : Any_Frames.Any_Frame; Status : out Send_Status)
   with
     Refined_Global =>
       (In_Out => (Transmit.State, Work), Output => Is_Filled)
   is
      Result : Queueing.Put_Status;
   begin
      Transmit.Put (F, Result);
      Is_Filled := True;
      Set_True (Work);
      Status :=
        (if Result = Queueing.Rejected_Full then Rejected_Full else Queued);
   end Send;

   procedure Wait_Frame
     (F : out Any_Frames.Any_Frame; Stamp : out Nanoseconds)
   with Refined_Global => (In_Out => (Received.State, Received.Wake_Up))
   is
   begin
      Received.Wait (F, Stamp);
   end Wait_Frame;

   procedure Read_State (Now : out Controller_State)
   with Refined_Global => Board
   is
      Log : constant Fault_Notices.Fault_Log := Board.Faults;
   begin
      Now := Log.State;
   end Read_State;

   procedure Read_Faults (Log : out Fault_Notices.Fault_Log)
   with Refined_Global => Board
   is
   begin
      Log := Board.Faults;
   end Read_Faults;

   procedure Request_Recovery
   with Refined_Global => (In_Out => Work, Output => Recovery_Asked)
   is
   begin
      Recovery_Asked := True;
      Set_True (Work);
   end Request_Recovery;

   procedure Read_Counters (C : out Counters)
   with Refined_Global => (Transmit.State, Received.State, Board)
   is
      Not_Queued : constant Event_Count := Transmit.Lost;
      Not_Taken  : constant Event_Count := Received.Lost;
   begin
      C          := Board.All_Counts;
      C.Lost_Out := Sum (C.Lost_Out, Not_Queued);
      C.Lost_In  := Sum (C.Lost_In, Not_Taken);
   end Read_Counters;

   procedure Take_Queued
     (F : out Any_Frames.Any_Frame; Status : out Queueing.Take_Status)
   with Refined_Global => (In_Out => (Transmit.State, Is_Filled))
   is
      Filled : constant Boolean := Is_Filled;
   begin
      if Filled then
         --  A frame that is queued from here on sets it again.
         Is_Filled := False;
         Transmit.Take (F, Status);
         if Status = Queueing.Taken then
            Is_Filled := True;
         end if;
      else
         F      := Any_Frames.Null_Any_Frame;
         Status := Queueing.Empty;
      end if;
   end Take_Queued;

   procedure Wait_Queued (F : out Any_Frames.Any_Frame)
   with Refined_Global => (In_Out => (Transmit.State, Is_Filled, Work))
   is
      Status : Queueing.Take_Status;
   begin
      loop
         Take_Queued (F, Status);
         exit when Status = Queueing.Taken;
         Suspend_Until_True (Work);
      end loop;
   end Wait_Queued;

   procedure Wait_Work
   with Refined_Global => (In_Out => Work)
   is
   begin
      Suspend_Until_True (Work);
   end Wait_Work;

   procedure Wake
   with Refined_Global => (In_Out => Work)
   is
   begin
      Set_True (Work);
   end Wake;

   procedure Take_Request (Is_Asked : out Boolean)
   with Refined_Global => (In_Out => Recovery_Asked)
   is
   begin
      Is_Asked := Recovery_Asked;
      if Is_Asked then
         Recovery_Asked := False;
      end if;
   end Take_Request;

   procedure Receive (F : Any_Frames.Any_Frame)
   with
     Refined_Global =>
       (In_Out => (Received.State, Received.Wake_Up, Board),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time))
   is
   begin
      if Any_Frames.Fits (F, Setting)
        and then Accepts (Any_Frames.Id (F), Any_Frames.Format (F))
      then
         Board.Count_Received;
         Received.Put (F);
      end if;
   end Receive;

   procedure Note (Now : Controller_State)
   with Refined_Global => (In_Out => Board)
   is
   begin
      Board.Note (Now);
   end Note;

   procedure Note_Traffic
   with Refined_Global => (In_Out => Board)
   is
   begin
      Board.Note_Traffic;
   end Note_Traffic;

   procedure Note_Errors (Transmit, Receive : Error_Count)
   with Refined_Global => (In_Out => Board)
   is
   begin
      Board.Note_Errors (Transmit, Receive);
   end Note_Errors;

   procedure Count (What : Counted; By : Event_Count := 1)
   with Refined_Global => (In_Out => Board)
   is
   begin
      Board.Count (What, By);
   end Count;

end Ravenchart.Can.Upper_Halves;
