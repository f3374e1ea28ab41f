--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Bounded queue whose elements release a sporadic processor: the event queue
--  of a region that releases one.
--
--  Guarantees   those of Ravenchart.Releasing_Queues; the number of elements
--               can be read as that of a queue that releases nothing
--  Tasking      any number of callers up to Ceiling; one caller of Wait, which
--               alone calls Take
--  Timing       constant; only Wait suspends
--  Analysis     one shared object, ceiling Ceiling

with System;
with Ravenchart.Queueing;

generic
   type Element_Type is private;
   Null_Element : Element_Type;
   --  The element that Take returns when Empty.
   Capacity : Queueing.Capacity_Type;
   Ceiling : System.Any_Priority;
   --  At least the priority of every caller.
   Policy : Queueing.Overflow_Policy;
   --  The policy of a Put that names no other one.
package Ravenchart.Releasing_Events
  with
    SPARK_Mode,
    Abstract_State =>
      ((State with Synchronous, External => (Async_Readers, Async_Writers)),
       (Wake_Up with Synchronous, External)),
    Initializes    => (State, Wake_Up)
is
   procedure Put
     (Item      : Element_Type;
      Status    : out Queueing.Put_Status;
      When_Full : Queueing.Overflow_Policy := Policy)
   with Global => (In_Out => (State, Wake_Up));
   --  Queue Item and wake the caller of Wait; a full queue gives up an element
   --  and counts it.

   procedure Take (Item : out Element_Type; Status : out Queueing.Take_Status)
   with Global => (In_Out => State);
   --  Hand over the oldest element, or Null_Element when Empty.

   procedure Wait
   with Global => (Input => State, In_Out => Wake_Up);
   --  Suspend the one caller until there is an element.

   procedure Read_Fill (Found : out Queueing.Fill)
   with Global => (Input => State);
   --  How many elements wait, and the most that ever waited.

   function Is_Empty return Boolean
   with Volatile_Function, Global => State;

   function Lost return Event_Count
   with Volatile_Function, Global => State;
   --  How many elements were rejected or dropped.

end Ravenchart.Releasing_Events;
