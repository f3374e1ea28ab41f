--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The serial line of the slcan driver, where an slcan adapter is to be at the
--  other end.
--
--  Guarantees   a line that is not there shows as No_Socket
--  Tasking      one task
--  Timing       that of the system

with Ravenchart.Can.Sockets;

package Ravenchart.Can.Serial_Lines
  with SPARK_Mode
is

   procedure Ask (Wanted : out Boolean)
   with Global => (In_Out => Sockets.Network);
   --  Does RAVENCHART_CAN_DEVICE name a serial line?

   procedure Open (Bus : Bus_Setting; Line : out Sockets.Socket)
   with Global => (In_Out => Sockets.Network);
   --  Open that line as it is set, without echo and translation; tell the
   --  slcan adapter there its bit rates and to open its channel, and announce
   --  it on standard output. Its commands S and Y have digits for usual bit
   --  rates alone, and Y is told where CAN FD frames switch to a whole number
   --  of Mbit/s; the digit that RAVENCHART_CAN_SPEED names goes before.

end Ravenchart.Can.Serial_Lines;
