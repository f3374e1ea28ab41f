--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A value that comes in segments, between the reception of its bus, which
--  takes them, and the port region of its port, which sends flow control and
--  ends a transfer that falls silent.
--
--  Guarantees   each transfer that is given up is told once, by Take or by
--               Look; the data of a value are whole
--  Tasking      the reception calls Take and Read, one port region calls Look
--  Timing       the time to copy a Receiver; never blocks
--  Analysis     one shared object, ceiling Ceiling

with Interfaces;
with Ravenchart.Can.Iso_Tp.Receivers;
with System;

generic
   Segments : Receivers.Setting;
   Ceiling : System.Any_Priority;
   --  At least the priority of both tasks.
package Ravenchart.Can.Iso_Tp.Reassemblies
  with
    SPARK_Mode,
    Abstract_State =>
      (State with Synchronous, External => (Async_Readers, Async_Writers)),
    Initializes    => State
is
   type Flow_Request is record
      Count  : Event_Count := 0;
      Status : Flow_Status := Continue_To_Send;
   end record;
   --  The flow control to send: its Count changes with each one.

   procedure Take
     (Payload : Interfaces.Unsigned_64;
      Length  : Data_Length;
      Stamp   : Nanoseconds;
      Result  : out Receivers.Outcome)
   with Global => (In_Out => State);
   --  A frame of Length bytes has come at Stamp.

   procedure Read (Value : out Value_Bytes)
   with Global => (Input => State);
   --  The value, after Take has found it Complete.

   procedure Look
     (Now     : Nanoseconds;
      Wanted  : out Flow_Request;
      Expired : out Boolean)
   with Global => (In_Out => State);
   --  What is to be sent; and whether a transfer has just been given up,
   --  because the time is Now.

end Ravenchart.Can.Iso_Tp.Reassemblies;
