--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A CAN controller. The subunit Driver of its body is a driver that the
--  project file selects.
--
--  Guarantees   frames leave in the order sent, or the most urgent first where
--               the driver's transmit buffers are by priority, and arrive in
--               the order received. A frame that does not fit is counted. The
--               log of faults has every change of state that the driver sees
--               (docs/drivers.md), however short
--  Tasking      Send, Read_State, Read_Faults, Read_Counters and
--               Request_Recovery by any task up to Transmit_Ceiling; one
--               caller of Wait_Frame, up to Receive_Ceiling
--  Timing       constant; only Wait_Frame suspends
--  Analysis     the driver's tasks at Driver_Priority, and shared objects
--               at the two ceilings
--  Assumptions  those of the driver that is selected

with System;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fault_Notices;
with Ravenchart.Queueing;

generic
   Transmit_Ceiling : System.Any_Priority;
   --  At least Driver_Priority and the priority of every sender.
   Receive_Ceiling : System.Any_Priority;
   --  At least Driver_Priority and the priority of the receiver.
   Driver_Priority : System.Priority;
   Transmit_Depth : Queueing.Capacity_Type;
   Receive_Depth : Queueing.Capacity_Type;
   Stack_Bytes : Positive;
   --  The stack of each task of the driver.
   with function Accepts
     (Id : Identifier; Format : Frame_Format) return Boolean;
   --  The acceptance filter: frames it refuses are not received.
   Setting : Bus_Setting;
   --  The configuration of the bus.
   Bus_Number : Bus_Place := 1;
   Bus_Name : String := "";
   --  In upper case. Variables of the environment that end in it are for this
   --  bus alone.
package Ravenchart.Can.Controllers
  with
    SPARK_Mode,
    Elaborate_Body,
    Abstract_State =>
      ((State with Synchronous, External => (Async_Readers, Async_Writers)),
       (Wake_Up with Synchronous, External)),
    Initializes    => (State, Wake_Up)
is
   pragma Assert
     (Driver_Priority <= Transmit_Ceiling
      and then Driver_Priority <= Receive_Ceiling
      and then Bus_Name'Length <= 64);

   Given_Priority : constant System.Priority := Driver_Priority;
   Given_Setting  : constant Bus_Setting := Setting;
   Given_Number   : constant Bus_Place := Bus_Number;
   --  The controller as it runs, for comparison with a timing certificate.

   procedure Send (F : Any_Frames.Any_Frame; Status : out Send_Status)
   with
     Global => (In_Out => (State, Wake_Up)),
     Pre    => Any_Frames.Fits (F, Setting);
   --  Queue F for transmission; a full queue rejects it.

   procedure Wait_Frame
     (F : out Any_Frames.Any_Frame; Stamp : out Nanoseconds)
   with Global => (In_Out => (State, Wake_Up));
   --  Suspend the one caller until there is a frame, and hand it over with the
   --  time since Epochs.Start at which the driver received it, 0 before that.
   --  Only frames that fit the setting come.

   procedure Read_State (Now : out Controller_State)
   with Global => (Input => State);
   --  The state of the controller on the bus.

   procedure Read_Faults (Log : out Fault_Notices.Fault_Log)
   with Global => (Input => State);
   --  The state, and the number of entries into error-passive and bus-off.

   procedure Request_Recovery
   with Global => (In_Out => Wake_Up);
   --  Request recovery of a controller that is bus-off, where Setting.Recovery
   --  is On_Request. In any other state there is nothing to recover from, and
   --  the request is ignored; a repeated request changes nothing.

   procedure Read_Counters (C : out Counters)
   with Global => (Input => State);
   --  Copy all counters.

end Ravenchart.Can.Controllers;
