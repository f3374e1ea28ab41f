--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The common part of all sockets.
--
--  Guarantees   no exception is raised
--  Tasking      the two tasks of a driver; each call is independent
--  Timing       that of the system

package Ravenchart.Can.Sockets
  with
    SPARK_Mode,
    Abstract_State =>
      (Network with Synchronous,
                    External => (Async_Readers, Async_Writers,
                                 Effective_Reads, Effective_Writes)),
    Initializes    => Network
is
   type Socket is range -1 .. 2**31 - 1;
   --  A descriptor of the operating system.

   No_Socket : constant Socket := -1;
   --  The result of a failed call.

   procedure Close (Old : Socket)
   with Global => (In_Out => Network);
   --  Give Old back to the system.

end Ravenchart.Can.Sockets;
