--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Last value of a datum that a task of one core writes and a task of another
--  core reads: the four-slot mechanism (H. R. Simpson, Four-slot fully
--  asynchronous communication mechanism, IEE Proceedings 137 E, 1990).
--
--  Guarantees   the reader gets a whole value: the last one written before
--               Read began, or a later one, and none older than before.
--               proofs/interleavings proves it over every interleaving
--  Tasking      one task writes, one task reads; neither ever waits
--  Timing       the time to copy one Element_Type, and four atomic accesses
--  Analysis     no shared object: no ceiling, no blocking
--  Assumptions  ASM-023, atomic objects order the accesses of two cores

generic
   type Element_Type is private;
   Initial : Element_Type;
   --  The value before the first Write.
package Ravenchart.Crossing_Boards
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
   with Global => (In_Out => State);
   --  Copy the value out.

end Ravenchart.Crossing_Boards;
