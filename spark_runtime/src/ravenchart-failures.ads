--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What ends a controller for good: a task that has ended, and a processor
--  that is silent.
--
--  Guarantees   the reason of each failure is kept, with the name of its task,
--               until Put_Reasons; a task that ends by itself or by an
--               exception is a failure without any call; an exception in the
--               environment task ends the program
--  Tasking      any task; nothing here blocks but what begins with Put, and
--               Give_Up
--  Timing       constant; these may wait for the host
--  Assumptions  ASM-014, the body does what is said here

package Ravenchart.Failures
  with
    SPARK_Mode,
    Elaborate_Body,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   Longest_Name : constant := 128;

   procedure Register (Name : String)
   with
     Global => (In_Out => State),
     Pre    => Name'Length in 1 .. Longest_Name;
   --  The calling task has this name. One that never registers is reported
   --  as a task without a name.

   procedure Note_Silence (Name : String)
   with
     Global => (In_Out => State),
     Pre    => Name'Length in 1 .. Longest_Name;
   --  The processor with this name is silent. The first one that is loses its
   --  urgency, where the target can take it away: the others then run.

   function Stop_Needed return Boolean
   with Volatile_Function, Global => State;
   --  Is there a failure? Then the controller shuts down.

   procedure Put_Error (Text : String)
   with
     Global => (In_Out => State),
     Pre    => Text'Length in 1 .. 400;
   --  Hand a line over to the host.

   procedure Put_Reasons
   with Global => (In_Out => State);
   --  Hand each reason to the host, oldest first.

   procedure Feed_Watchdog
   with Global => (In_Out => State);
   --  All is well: the watchdog of the target may wait for its time again.

   procedure Give_Up
   with Global => (In_Out => State);
   --  An orderly end has not come about: hand the reasons over and end here.

end Ravenchart.Failures;
