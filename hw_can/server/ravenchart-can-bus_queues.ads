--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The records that wait for one client of the bus server.
--
--  Guarantees   first in, first out; no other record moves or is lost
--  Tasking      none: one owner for each Queue
--  Timing       constant

with Ravenchart.Can.Bus_Records;

package Ravenchart.Can.Bus_Queues
  with SPARK_Mode, Pure
is
   pragma Assertion_Policy (Post => Ignore);
   --  A check would copy and compare the queue for each record.

   Depth : constant := 4_096;
   --  Records that may wait for one client.

   subtype Waiting_Count is Natural range 0 .. Depth;

   subtype Waiting_Index is Waiting_Count range 1 .. Depth;

   type Outgoing is record
      Bytes : Bus_Records.Image := (others => 0);
      Due   : Nanoseconds := 0;
   end record;
   --  A record, and the bus time from which it may be handed over.

   type Outgoing_List is array (Waiting_Index) of Outgoing;

   type Queue is record
      First : Waiting_Index := 1;
      Count : Waiting_Count := 0;
      Ring  : Outgoing_List;
   end record;
   --  First is the place of the head; place 1 follows the last place.

   function Place (Q : Queue; Index : Waiting_Index) return Waiting_Index
   is (if Q.First - 1 <= Depth - Index
       then Q.First - 1 + Index
       else Q.First - 1 + Index - Depth)
   with Global => null;
   --  The place in the ring of record Index, counted from the head as 1.

   function Item (Q : Queue; Index : Waiting_Index) return Outgoing
   is (Q.Ring (Place (Q, Index)))
   with Global => null;
   --  That record.

   procedure Put (Q : in out Queue; What : Outgoing)
   with
     Global => null,
     Pre    => Q.Count < Depth,
     Post   =>
       Q.Count = Q.Count'Old + 1
       and then Item (Q, Q.Count) = What
       and then
         (for all I in 1 .. Q.Count'Old => Item (Q, I) = Item (Q'Old, I));
   --  Queue a record.

   procedure Drop_Head (Q : in out Queue)
   with
     Global => null,
     Pre    => Q.Count > 0,
     Post   =>
       Q.Count = Q.Count'Old - 1
       and then
         (for all I in 1 .. Q.Count => Item (Q, I) = Item (Q'Old, I + 1));
   --  Remove the head, which was handed over.

   procedure Clear (Q : in out Queue)
   with Global => null, Post => Q.Count = 0;
   --  Remove all records.

end Ravenchart.Can.Bus_Queues;
