--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A command of another node as its caller sees it: at most one call waits
--  for its reply, for Limit executions of the caller.
--
--  Guarantees   those of Calls
--  Tasking      any task up to Ceiling
--  Timing       constant, never blocks
--  Analysis     one shared object, ceiling Ceiling

with System;
with Ravenchart.Calls;
with Ravenchart.Queueing;

generic
   Limit : Calls.Execution_Limit;
   --  Executions of the caller after which a call is given up.
   Ceiling : System.Any_Priority;
   --  At least the priority of every caller.
package Ravenchart.Remote_Calls
  with
    SPARK_Mode,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   procedure Start
     (Number : out Calls.Call_Number; Status : out Queueing.Put_Status)
   with Global => (In_Out => State);
   --  Begin a call, unless one waits: then Status is Rejected_Full.

   procedure Finish
     (Number : Calls.Call_Number; Status : out Calls.Reply_Status)
   with Global => (In_Out => State);
   --  A reply has come to the call with this number.

   procedure Tick (Status : out Calls.Wait_Status)
   with Global => (In_Out => State);
   --  One more execution of the caller has begun.

end Ravenchart.Remote_Calls;
