--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The upper half of a CAN driver, the same for every driver. It holds the
--  queues between the program and the tasks of the driver, the state and the
--  counters of the controller, and the request for recovery.
--
--  Guarantees   frames leave each queue in the order in which they came; a
--               frame that does not fit is rejected and counted; no wake-up of
--               the driver is lost
--  Tasking      the operations of the program as in Controllers; the others
--               by the tasks of the driver, with one caller of Take_Queued,
--               Wait_Queued, Wait_Work and Take_Request
--  Timing       constant, and one reading of the clock in Receive; only
--               Wait_Frame, Wait_Queued and Wait_Work suspend
--  Analysis     two shared objects with ceiling Transmit_Ceiling, one with
--               ceiling Receive_Ceiling

with Ada.Real_Time;
with System;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fault_Notices;
with Ravenchart.Epochs;
with Ravenchart.Queueing;

generic
   Transmit_Ceiling : System.Any_Priority;
   --  At least the priority of the driver and of every sender.
   Receive_Ceiling : System.Any_Priority;
   --  At least the priority of the driver and of the receiver.
   Transmit_Depth : Queueing.Capacity_Type;
   Receive_Depth : Queueing.Capacity_Type;
   with function Accepts
     (Id : Identifier; Format : Frame_Format) return Boolean;
   --  The acceptance filter.
   Setting : Bus_Setting;
   --  The configuration of the bus.
package Ravenchart.Can.Upper_Halves
  with
    SPARK_Mode,
    Abstract_State =>
      ((State with Synchronous, External => (Async_Readers, Async_Writers)),
       (Wake_Up with Synchronous, External)),
    Initializes    => (State, Wake_Up)
is
   --  For the program: the operations of Controllers

   procedure Send (F : Any_Frames.Any_Frame; Status : out Send_Status)
   with Global => (In_Out => (State, Wake_Up));

   procedure Wait_Frame
     (F : out Any_Frames.Any_Frame; Stamp : out Nanoseconds)
   with Global => (In_Out => (State, Wake_Up));

   procedure Read_State (Now : out Controller_State)
   with Global => (Input => State);

   procedure Read_Faults (Log : out Fault_Notices.Fault_Log)
   with Global => (Input => State);

   procedure Request_Recovery
   with Global => (In_Out => Wake_Up);

   procedure Read_Counters (C : out Counters)
   with Global => (Input => State);

   --  For the tasks of the driver: work

   procedure Take_Queued
     (F : out Any_Frames.Any_Frame; Status : out Queueing.Take_Status)
   with Global => (In_Out => (State, Wake_Up));
   --  Take the oldest frame of the transmit queue, or a null frame when
   --  Empty. While the program sends nothing, this takes no lock.

   procedure Wait_Queued (F : out Any_Frames.Any_Frame)
   with Global => (In_Out => (State, Wake_Up));
   --  Suspend the caller until the transmit queue has a frame, and take it.

   procedure Wait_Work
   with Global => (In_Out => Wake_Up);
   --  Suspend the caller until a frame was queued, recovery was requested or
   --  Wake was called since the last return.

   procedure Wake
   with Global => (In_Out => Wake_Up);
   --  Let the caller of Wait_Work return.

   procedure Take_Request (Is_Asked : out Boolean)
   with Global => (In_Out => Wake_Up);
   --  Was recovery requested since the last call?

   --  For the tasks of the driver: results

   procedure Receive (F : Any_Frames.Any_Frame)
   with
     Global =>
       (In_Out => (State, Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time));
   --  F came over the bus. If it fits the setting and passes the acceptance
   --  filter, count it and hand it to the program.

   procedure Note (Now : Controller_State)
   with Global => (In_Out => State);
   --  The controller is in state Now.

   procedure Note_Traffic
   with Global => (In_Out => State);
   --  The bus has carried a frame: a controller that was Stopped is now
   --  Error_Active.

   procedure Note_Errors (Transmit, Receive : Error_Count)
   with Global => (In_Out => State);
   --  Note the error counters of the controller.

   type Counted is (Sent, Lost_Out, Lost_In, Rejected_Line);
   --  The counter that Count adds to: see Counters.

   procedure Count (What : Counted; By : Event_Count := 1)
   with Global => (In_Out => State);
   --  Add By to a counter, up to its last value.

end Ravenchart.Can.Upper_Halves;
