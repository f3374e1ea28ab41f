--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The socket calls of the drivers that use TCP on this machine: a server with
--  one client at a time, or a client.
--
--  Guarantees   a lost partner shows as an end of data or a failed Send, never
--               as a signal or an exception
--  Tasking      the two tasks of a driver; each call is independent
--  Timing       Accept_Client, Connect and the operations that receive or send
--               wait for the other side

with Interfaces;
with Ravenchart.Can.Sockets;

package Ravenchart.Can.Tcp_Sockets
  with SPARK_Mode
is
   use Sockets;

   type Octets is array (Positive range <>) of Interfaces.Unsigned_8;

   Chunk_Limit : constant := 256;
   --  The most bytes one Receive takes.

   subtype Chunk_Length is Natural range 0 .. Chunk_Limit;
   --  Bytes received.

   subtype Chunk is Octets (1 .. Chunk_Limit);
   --  Received bytes, and unused ones behind them.

   type Outcome is (Opened, None_Left, Refused);
   --  None_Left: the system has no more sockets. Refused: the port is in use,
   --  or no server listens there.

   procedure Open_Server
     (Asked  : Interfaces.Unsigned_16;
      Server : out Socket;
      Given  : out Interfaces.Unsigned_16;
      Result : out Outcome)
   with Global => (In_Out => Network);
   --  Listen on the port Asked, or for 0 on a port that the system chooses;
   --  Given is that port. No_Socket when it is not Opened.

   procedure Accept_Client (Server : Socket; Client : out Socket)
   with Global => (In_Out => Network);
   --  Wait for the next client.

   procedure Connect
     (Port   : Interfaces.Unsigned_16;
      Client : out Socket;
      Result : out Outcome)
   with Global => (In_Out => Network);
   --  Become a client of the server on that port of this machine; No_Socket
   --  when it is not Opened.

   procedure Receive
     (From : Socket; Bytes : out Chunk; Last : out Chunk_Length)
   with Global => (In_Out => Network);
   --  Wait for bytes; Last = 0 when the other side has disconnected.

   procedure Receive_All
     (From : Socket; Bytes : out Octets; Done : out Boolean)
   with Global => (In_Out => Network);
   --  Wait until Bytes are full; not Done when the other side has disconnected
   --  before.

   type Patience is range 0 .. 60_000;
   --  A time in milliseconds; 0 means no limit.

   procedure Limit_Wait
     (Partner : Socket; To : Patience; Done : out Boolean)
   with Global => (In_Out => Network);
   --  Limit the time that each receiving call waits for Partner; after that
   --  the call fails as if the other side had disconnected. Not Done where the
   --  system has no such limit.

   procedure Send (To : Socket; Bytes : Octets; Done : out Boolean)
   with Global => (In_Out => Network);
   --  Send all of Bytes as the other side accepts them; not Done when it has
   --  disconnected. Receive and Send serve a serial line as well.

   procedure Break_Off (Partner : Socket)
   with Global => (In_Out => Network);
   --  End the connection and any call that waits on it; Partner stays valid.

end Ravenchart.Can.Tcp_Sockets;
