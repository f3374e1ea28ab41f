--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The sockets, the clock and the signals of the bus server.
--
--  Guarantees   only Await waits, and at most for the time given; a client
--               that has disconnected disturbs no other one
--  Tasking      the environment task only
--  Timing       Await: at most the time given

with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Bus_Records;

package Ravenchart.Can.Bus_Sockets is

   use Bus_Nodes;

   procedure Open (Port : in out Natural; Opened : out Boolean);
   --  Listen on this port of this machine; for 0 on a free one. From here on
   --  SIGINT and SIGTERM end the process in good order.

   function Stop_Requested return Boolean;
   --  Has a signal requested the end of the server?

   function Clock return Nanoseconds;
   --  Time since Open, from a clock that is never set.

   function Date return Nanoseconds;
   --  Time since 1970-01-01 UTC.

   procedure Await (Most : Nanoseconds; Welcomes : Boolean);
   --  Wait until there is something to read, or a client accepts output again,
   --  at most for Most. Welcomes: also until a client wants to connect.

   function Somebody_Knocks return Boolean;
   --  Has the last Await seen a client that wants to connect?

   procedure Welcome (C : Node_Index);
   --  Accept the connection as that of client C.

   procedure Receive (C : Node_Index; Gone : out Boolean);
   --  Read the input of C that the last Await has seen, as far as there is
   --  room.

   procedure Take
     (C : Node_Index; Bytes : out Bus_Records.Image; Whole : out Boolean);
   --  Take the next record, if all of it has come.

   type Writing is (Done, Full, Lost);

   function Has_Room (C : Node_Index) return Boolean;
   --  Is there room for one more record to be written?

   procedure Send (C : Node_Index; Bytes : Bus_Records.Image);
   --  Add a record, when there is room. Flush writes it.

   function Flush (C : Node_Index) return Writing;
   --  Write the records, as far as C accepts them.

   procedure Close (C : Node_Index);
   --  End the connection.

end Ravenchart.Can.Bus_Sockets;
