--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A value that comes in segments. The reception of its bus takes the
--  segments. The port region of its port sends flow control, and ends a
--  transfer whose segments do not come.
--
--  Guarantees   each transfer that is given up is reported once, by Take or by
--               Look; the data of a value are complete
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
   --  The flow control to send. Its Count changes with each one.

   procedure Take
     (Payload : Interfaces.Unsigned_64;
      Length  : Data_Length;
      Stamp   : Nanoseconds;
      Result  : out Receivers.Outcome)
   with Global => (In_Out => State);
   --  A frame of Length bytes has come at Stamp.

   procedure Read (Value : out Value_Bytes)
   with Global => (Input => State);
   --  The value. Call it after Take has found the value Complete.

   procedure Look
     (Now     : Nanoseconds;
      Wanted  : out Flow_Request;
      Expired : out Boolean)
   with Global => (In_Out => State);
   --  The flow control to send at the time Now. Expired: the transfer has just
   --  been given up because of its time-out.

end Ravenchart.Can.Iso_Tp.Reassemblies;
