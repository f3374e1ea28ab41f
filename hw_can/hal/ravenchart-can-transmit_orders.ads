--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The order in which a driver offers the waiting frames to each bus.
--
--  Guarantees   first in, first out, until the program sets a bus to the order
--               by priority; that order then stays
--  Tasking      Set_By_Priority by the main program alone; Read by any task
--  Timing       constant, without a lock
--  Assumptions  ASM-013: the main program sets the order before Epochs.Start

package Ravenchart.Can.Transmit_Orders
  with
    SPARK_Mode,
    Elaborate_Body,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   procedure Set_By_Priority (Bus : Bus_Place)
   with Global => (In_Out => State);
   --  From here on, the most urgent of the waiting frames goes to Bus first.

   procedure Read (Bus : Bus_Place; By_Priority : out Boolean)
   with Global => (Input => State);
   --  Does the most urgent of the waiting frames go to Bus first?

end Ravenchart.Can.Transmit_Orders;
