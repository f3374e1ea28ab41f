--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The few calls of the SocketCAN driver: one raw socket on one interface.
--
--  Guarantees   an interface that is down or gone shows as an outcome, never
--               as an exception
--  Tasking      the two tasks of the driver; each call is independent
--  Timing       Receive waits for the bus; Send does not wait

with Ravenchart.Can.Socket_Frames;
with Ravenchart.Can.Sockets;

package Ravenchart.Can.Raw_Sockets
  with SPARK_Mode
is
   use Sockets;

   type Outcome is (Done, Busy, Refused, Down, Gone);
   --  Busy: no room to send at present. Refused: the interface is not set up
   --  for CAN FD. Down: the interface is not up. Gone: the socket is no longer
   --  usable.

   type Opening is (Joined, No_Can, No_Interface);
   --  No_Can: the system has no SocketCAN.

   Name_Limit : constant := 64;
   --  More than Linux allows.

   procedure Open
     (Name    : String;
      With_Fd : Boolean;
      Opened  : out Socket;
      Result  : out Opening)
   with Global => (In_Out => Network), Pre => Name'Length <= Name_Limit;
   --  A socket on the interface with this name, with all error reports, and
   --  with CAN FD frames if Fd is requested; No_Socket when it has not Joined.

   procedure Receive
     (From   : Socket;
      Item   : out Socket_Frames.Item;
      Result : out Outcome)
   with
     Global => (In_Out => Network),
     Post   => Result not in Busy | Refused;
   --  Wait for a frame or an error report; a null item when not Done.

   procedure Send
     (To : Socket; Item : Socket_Frames.Item; Result : out Outcome)
   with Global => (In_Out => Network);
   --  Hand a frame to the interface's transmit queue.

end Ravenchart.Can.Raw_Sockets;
