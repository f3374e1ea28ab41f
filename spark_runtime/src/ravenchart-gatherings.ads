--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A call that goes to all elements of an array: at most one call is under
--  way, and it ends once, with the last of its elements.
--
--  Guarantees   those of Start and Conclude in the body
--  Tasking      any task up to Ceiling
--  Timing       the time to copy Last replies; never blocks
--  Analysis     one shared object, ceiling Ceiling

with System;
with Ravenchart.Answers;

generic
   type Part_Type is private;
   No_Part : Part_Type;
   --  The reply of an element that has not replied yet.
   Last : Positive;
   --  The number of elements.
   Ceiling : System.Any_Priority;
   --  At least the priority of every caller.
package Ravenchart.Gatherings
  with
    SPARK_Mode,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   subtype Element_Number is Positive range 1 .. Last;
   type Part_List is array (Element_Number) of Part_Type;

   procedure Start (Is_Refused : out Boolean)
   with Global => (In_Out => State);
   --  Begin a call of all elements, unless one is under way.

   procedure Conclude
     (Element : Element_Number;
      Given   : Answers.Answer;
      Part    : Part_Type;
      Result  : out Answers.Outcome;
      Parts   : out Part_List)
   with Global => (In_Out => State);
   --  The call of an element has ended, with the reply Part where it has
   --  Replied. Result is the outcome of the whole where that was the last one.
   --  With All_Replied, Parts has the replies of this call.

end Ravenchart.Gatherings;
