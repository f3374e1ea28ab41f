--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The failures that end a controller: a task that has ended, and a processor
--  that is silent.
--
--  Guarantees   the reason of each failure is kept, with the name of its task,
--               until Put_Reasons. A task that ends by itself or by an
--               exception is a failure without any call. An exception in the
--               environment task ends the program
--  Tasking      any task; only Put_Error, Put_Reasons and Give_Up may block
--  Timing       constant; those three may wait for the host
--  Assumptions  ASM-014, the body does what this specification states

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
   --  Give the calling task this name. A task that never registers is reported
   --  as a task without a name.

   procedure Note_Silence (Name : String)
   with
     Global => (In_Out => State),
     Pre    => Name'Length in 1 .. Longest_Name;
   --  The processor with this name is silent. The first silent one loses its
   --  priority where the target can lower it: the others then run.

   function Stop_Needed return Boolean
   with Volatile_Function, Global => State;
   --  Is there a failure? The controller then shuts down.

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
   --  Feed the watchdog of the target: no processor is silent.

   procedure Give_Up
   with Global => (In_Out => State);
   --  The orderly end has not come in time: hand the reasons over and end
   --  here.

end Ravenchart.Failures;
