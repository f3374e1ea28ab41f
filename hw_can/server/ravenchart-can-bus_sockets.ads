--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

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

   procedure Await (Most : Nanoseconds; Welcomes : Boolean);
   --  Wait until there is something to read, or to write to a client that
   --  took no more, and no longer than this. Welcomes: or somebody wants to
   --  connect.

   function Somebody_Knocks return Boolean;
   --  Has the last Await seen that somebody wants to connect?

   procedure Welcome (C : Node_Index);
   --  Accept the connection; it is that of client C.

   procedure Receive (C : Node_Index; Gone : out Boolean);
   --  Read what the last Await has seen of C, as far as there is room for.

   procedure Take
     (C : Node_Index; Bytes : out Bus_Records.Image; Whole : out Boolean);
   --  The next record that was read, if all of it is there.

   type Writing is (Done, Full, Lost);

   function Has_Room (C : Node_Index) return Boolean;
   --  Is there room for one more record to be written?

   procedure Send (C : Node_Index; Bytes : Bus_Records.Image);
   --  Only when there is room. Flush writes it.

   function Flush (C : Node_Index) return Writing;
   --  Write what was sent, as far as C takes it.

   procedure Close (C : Node_Index);
   --  End the connection.

end Ravenchart.Can.Bus_Sockets;
