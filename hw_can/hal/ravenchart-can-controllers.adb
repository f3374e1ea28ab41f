--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Two halves, as drivers commonly have them: the upper one is the same for
--  all drivers; the lower one is the driver, a subunit that the project file
--  selects.

with Ravenchart.Can.Upper_Halves;

package body Ravenchart.Can.Controllers
  with
    SPARK_Mode,
    Refined_State =>
      (State   => Upper.State,
       Wake_Up => (Upper.Wake_Up, Driver.State))
is
   package Upper is new Upper_Halves
     (Transmit_Ceiling => Transmit_Ceiling,
      Receive_Ceiling  => Receive_Ceiling,
      Transmit_Depth   => Transmit_Depth,
      Receive_Depth    => Receive_Depth,
      Accepts          => Accepts,
      Setting          => Setting);

   package Driver
     with
       Abstract_State => (State with Synchronous, External),
       Initializes    => State
   is
   end Driver;
   --  Tasks that move frames between the upper half and a bus, and report the
   --  state of the controller to the upper half.

   package body Driver is separate;

   procedure Send (F : Any_Frames.Any_Frame; Status : out Send_Status)
     renames Upper.Send;

   procedure Wait_Frame
     (F : out Any_Frames.Any_Frame; Stamp : out Nanoseconds)
     renames Upper.Wait_Frame;

   procedure Read_State (Now : out Controller_State)
     renames Upper.Read_State;

   procedure Read_Faults (Log : out Fault_Notices.Fault_Log)
     renames Upper.Read_Faults;

   procedure Request_Recovery
     renames Upper.Request_Recovery;

   procedure Read_Counters (C : out Counters)
     renames Upper.Read_Counters;

end Ravenchart.Can.Controllers;
