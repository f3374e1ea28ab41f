--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The services of a target for the report of a controller and for its end:
--  the one part of Hosts that each target has a body of.
--
--  Guarantees   a report that cannot be written never disturbs the controller:
--               it then ends early
--  Tasking      the environment task only
--  Timing       not bounded: it may wait for a disk or a serial line
--  Assumptions  ASM-002, the body does what this specification states

private package Ravenchart.Hosts.Services
  with
    SPARK_Mode,
    Abstract_State =>
      (State with External => (Async_Readers, Async_Writers,
                               Effective_Writes),
                  Part_Of  => Hosts.Process),
    Initializes    => State
is
   procedure Start
   with Global => (In_Out => State);
   --  Accept requests to stop, and begin the report.

   function Stop_Requested return Boolean
   with Volatile_Function, Global => State;
   --  Has the target received a request to end the controller?

   procedure Put (Text : String)
   with Global => (In_Out => State);
   --  Add Text to the report, if there is one.

   procedure Flush
   with Global => (In_Out => State);
   --  Write the buffered part of the report out.

   procedure Finish (Success : Boolean)
   with Global => (In_Out => State);
   --  End the program with status 0 on Success, else 1, on targets that have a
   --  status.

end Ravenchart.Hosts.Services;
