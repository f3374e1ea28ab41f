--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Bounded queue that one task waits on: the way into and out of a driver.
--
--  Guarantees   strict order; an element that does not fit is rejected and
--               counted; an element put is never left while the caller of Wait
--               suspends
--  Tasking      any number of callers up to Ceiling; one caller of Wait
--  Timing       constant; only Wait suspends
--  Analysis     one shared object, ceiling Ceiling
--
--  The wake-up is a suspension object, not an entry. In the run-time library
--  of GNAT for Linux (12 and earlier) the caller of a single entry tests once,
--  without a lock, whether its call is complete. If the call completes between
--  this test and the wait, the caller sleeps for ever.

with System;
with Ravenchart.Queueing;

generic
   type Element_Type is private;
   Null_Element : Element_Type;
   --  Fills the places that hold no element.
   Capacity : Queueing.Capacity_Type;
   Ceiling : System.Any_Priority;
   --  At least the priority of every caller.
package Ravenchart.Waiting_Queues
  with
    SPARK_Mode,
    Abstract_State =>
      ((State with Synchronous, External => (Async_Readers, Async_Writers)),
       (Wake_Up with Synchronous, External)),
    Initializes    => (State, Wake_Up)
is
   procedure Put (Item : Element_Type; Status : out Queueing.Put_Status)
   with Global => (In_Out => (State, Wake_Up));
   --  Queue Item and wake the caller of Wait; a full queue rejects it.

   procedure Wait (Item : out Element_Type)
   with Global => (In_Out => (State, Wake_Up));
   --  Suspend the one caller until there is an element, and hand it over.

   function Lost return Event_Count
   with Volatile_Function, Global => State;
   --  How many elements were rejected.

end Ravenchart.Waiting_Queues;
