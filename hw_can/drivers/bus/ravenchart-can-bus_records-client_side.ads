--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The records that a node sends to its bus server and receives from it
--  (docs/bus-protocol.md).
--
--  Guarantees   reading is total: any bytes give an answer that keeps every
--               rule of the page, or Broken
--  Tasking      none: records are values
--  Timing       constant

with Ravenchart.Can.Any_Frames;

package Ravenchart.Can.Bus_Records.Client_Side
  with SPARK_Mode, Pure
is
   type Answer_Kind is
     (Taken_In,
      Frame_Came,
      State_Told,
      Confirmed,
      Refused,
      Noted,
      Closed,
      Turned_Away,
      Broken);
   --  The kinds of answers of a server. Noted: an error frame, which a node
   --  ignores. Closed: the server ends. Turned_Away: the server ends the
   --  connection for another reason.

   type Answer is record
      Kind            : Answer_Kind := Broken;
      Number          : Interfaces.Unsigned_32 := 0;
      Transmit_Errors : Error_Count := 0;
      Receive_Errors  : Error_Count := 0;
      Came            : Any_Frames.Any_Frame;
   end record;
   --  Number belongs to Confirmed and Refused, the counters to State_Told, and
   --  Came is the frame that came.

   function Heard (Bytes : Image) return Answer
   with
     Global => null,
     Post   =>
       (if Heard'Result.Kind in Confirmed | Refused
        then Heard'Result.Number > 0);
   --  The answer in a record of the server.

   function Hello (Name : String; Takes_Fd : Boolean) return Image
   with Global => null, Pre => Is_Name (Name);
   --  The first record: a node, which takes any bit rate. A node that does not
   --  take CAN FD receives no CAN FD frames.

   function Request
     (F : Any_Frames.Any_Frame; Number : Interfaces.Unsigned_32) return Image
   with Global => null, Pre => Number > 0;
   --  The request to transmit F.

   function Recovery return Image
   with Global => null;
   --  The request to recover from bus-off.

end Ravenchart.Can.Bus_Records.Client_Side;
