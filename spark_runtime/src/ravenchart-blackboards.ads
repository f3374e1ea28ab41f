--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Last value of a sampled datum: one writer, any number of readers.
--
--  Guarantees   readers get a copy of one whole value, never a mixture
--  Tasking      any task up to Ceiling
--  Timing       the time to copy one Element_Type; never blocks
--  Analysis     one shared object, ceiling Ceiling

with System;

generic
   type Element_Type is private;
   Initial : Element_Type;
   --  The value before the first Write.
   Ceiling : System.Any_Priority;
   --  At least the priority of every caller.
package Ravenchart.Blackboards
  with
    SPARK_Mode,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   procedure Write (Item : Element_Type)
   with Global => (In_Out => State);
   --  Replace the value.

   procedure Read (Item : out Element_Type)
   with Global => (Input => State);
   --  Copy the value out.

end Ravenchart.Blackboards;
