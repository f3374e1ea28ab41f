--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What a node says to its bus server, and what it hears from it
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
   --  What a server can say. Noted: an error frame, of which a node makes
   --  nothing. Closed: the server ends. Turned_Away: it ends the connection
   --  for another reason.

   type Answer is record
      Kind            : Answer_Kind := Broken;
      Number          : Interfaces.Unsigned_32 := 0;
      Transmit_Errors : Error_Count := 0;
      Receive_Errors  : Error_Count := 0;
      Came            : Any_Frames.Any_Frame;
   end record;
   --  Number of the request that is Confirmed or Refused, counters of
   --  State_Told, and the frame that Came.

   function Heard (Bytes : Image) return Answer
   with
     Global => null,
     Post   =>
       (if Heard'Result.Kind in Confirmed | Refused
        then Heard'Result.Number > 0);
   --  What a server has said.

   function Hello (Name : String; Takes_Fd : Boolean) return Image
   with Global => null, Pre => Is_Name (Name);
   --  The first record: a node, which takes any bit rate. One that does not
   --  take CAN FD is told of no such frames.

   function Request
     (F : Any_Frames.Any_Frame; Number : Interfaces.Unsigned_32) return Image
   with Global => null, Pre => Number > 0;
   --  Asks for F to be transmitted.

   function Recovery return Image
   with Global => null;
   --  Asks for the way out of bus-off.

end Ravenchart.Can.Bus_Records.Client_Side;
