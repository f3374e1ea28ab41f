--  The sockets, the clock and the signals of the bus server.
--
--  Guarantees   nothing here waits but Await, and that not for longer than
--               it is told; a client that is gone disturbs nobody
--  Tasking      the environment task only
--  Timing       Await: as long as it is told

with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Bus_Records;

package Ravenchart.Can.Bus_Sockets is

   use Bus_Nodes;

   procedure Open (Port : in out Natural; Opened : out Boolean);
   --  Listen on this port of this machine; on a free one for 0. The process
   --  ends in good order on SIGINT and SIGTERM from here on.

   function Stop_Requested return Boolean;
   --  Has a signal asked the server to end?

   function Clock return Nanoseconds;
   --  Time since Open, from a clock that is never set.

   function Date return Nanoseconds;
   --  Time since 1970-01-01 UTC.

   procedure Await (Most : Nanoseconds);
   --  Wait until there is something to read, and no longer than this.

   function Somebody_Knocks return Boolean;
   --  Does somebody want to connect?

   procedure Welcome (C : Node_Index);
   --  Accept the connection; it is that of client C.

   type Reading is (Nothing, Whole, Gone);

   procedure Receive
     (C : Node_Index; Bytes : out Bus_Records.Image; Read : out Reading);
   --  The next record that C has sent, once all of it is there.

   type Writing is (Done, Full, Lost);

   function Ready (C : Node_Index) return Writing;
   --  Does C take a record now? Writes what is left of the last one.

   procedure Send (C : Node_Index; Bytes : Bus_Records.Image);
   --  Only when it is ready: Done.

   procedure Close (C : Node_Index);
   --  End the connection.

end Ravenchart.Can.Bus_Sockets;
