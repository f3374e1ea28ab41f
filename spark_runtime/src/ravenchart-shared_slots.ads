--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Places for values in memory that two cores share, without a lock. The unit
--  that owns them lets no two tasks use one place at the same time, and orders
--  their accesses by atomic objects.
--
--  Guarantees   Read gives what the last Write into the place has left there
--  Tasking      one task at a time for each place
--  Timing       the time to copy one Element_Type; never waits
--  Assumptions  ASM-023, the body is outside SPARK; atomic objects order the
--               accesses of two cores

generic
   type Element_Type is private;
   Initial : Element_Type;
   --  The value of each place before the first Write.
   Last : Natural;
   --  The places are 0 .. Last.
package Ravenchart.Shared_Slots
  with
    SPARK_Mode,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   subtype Place_Number is Natural range 0 .. Last;

   procedure Write (Place : Place_Number; Item : Element_Type)
   with Global => (In_Out => State);
   --  Replace the value in a place.

   procedure Read (Place : Place_Number; Item : out Element_Type)
   with Global => (Input => State);
   --  Copy the value in a place.

end Ravenchart.Shared_Slots;
