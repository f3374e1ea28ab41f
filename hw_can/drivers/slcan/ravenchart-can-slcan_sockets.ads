--  The few socket calls of the slcan driver: a server on 127.0.0.1 with one
--  client at a time.
--
--  Guarantees   a lost client shows as an end of data or a failed Send, never
--               as a signal or an exception
--  Tasking      the two tasks of the driver; each call is independent
--  Timing       Accept_Client, Receive and Send wait for the other side

with Interfaces;
with Ravenchart.Can.Slcan;

package Ravenchart.Can.Slcan_Sockets
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
   --  What a failed call hands over.

   Chunk_Limit : constant := 256;
   --  The most bytes one Receive takes.

   subtype Chunk_Length is Natural range 0 .. Chunk_Limit;
   --  Bytes received.

   type Chunk is array (Positive range 1 .. Chunk_Limit)
     of Interfaces.Unsigned_8;
   --  Received bytes, and unused ones behind them.

   procedure Open_Server (Server : out Socket)
   with Global => (In_Out => Network);
   --  Listen on the port that RAVENCHART_CAN_PORT names, or on one that the
   --  system chooses, and announce it on standard output.

   procedure Accept_Client (Server : Socket; Client : out Socket)
   with Global => (In_Out => Network);
   --  Wait for the next client.

   procedure Receive
     (Client : Socket; Bytes : out Chunk; Last : out Chunk_Length)
   with Global => (In_Out => Network);
   --  Wait for bytes; Last = 0 when the client has gone.

   procedure Send
     (Client : Socket;
      Line   : Slcan.Line_Bytes;
      Last   : Slcan.Line_Length;
      Done   : out Boolean)
   with Global => (In_Out => Network);
   --  Send a whole line, as soon as the client takes it; not Done when the
   --  client has gone.

   procedure Break_Off (Client : Socket)
   with Global => (In_Out => Network);
   --  End the connection, and with it a Send that waits; Client stays valid.

   procedure Close (Client : Socket)
   with Global => (In_Out => Network);
   --  Give Client back to the system.

end Ravenchart.Can.Slcan_Sockets;
