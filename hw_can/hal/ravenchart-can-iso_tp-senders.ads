--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The sender of values in segments (ISO 15765-2): at most one segment at the
--  end of each execution of the row that sends.
--
--  Guarantees   segments go in order, each byte once. A segment is due only
--               Distance executions after the last one, or more where the
--               receiver requests it. A receiver that is silent, asks for too
--               many waits or has no room ends the transfer
--  Tasking      none: the task of the row owns the Sender
--  Timing       linear in the length of the value
--
--  Time counts in executions of the row. Timeout is N_Bs, Waits N_WFTmax.

package Ravenchart.Can.Iso_Tp.Senders
  with SPARK_Mode, Pure
is
   use type Fd_Frames.Fd_Bytes;

   subtype Turns is Execution_Count range 1 .. Execution_Count'Last;

   type Row_Period is range 1 .. 2**30;
   --  The period of the row in microseconds, rounded down.

   type Setting is record
      Length   : Value_Length := 8;
      Distance : Turns        := 1;
      Timeout  : Turns        := 1;
      Waits    : Block_Size   := 0;
      Row      : Row_Period   := 1;
   end record;
   --  Length: bytes of a value. Distance: the least number of executions from
   --  one segment to the next. Timeout: executions for which flow control is
   --  awaited. Waits: how often in a row the receiver may answer with Wait.

   type Flow_Notice is record
      Count      : Event_Count  := 0;
      Status     : Flow_Status  := Invalid;
      Block      : Block_Size   := 0;
      Separation : Microseconds := 0;
   end record;
   --  The last flow control, and the number of flow controls that have come.

   type Sender_Phase is (Idle, Starting, Awaiting_Flow, Sending);
   --  Starting: the first segment is next. Sending: a consecutive one is.

   type Sender is record
      Phase    : Sender_Phase    := Idle;
      Has_Next : Boolean         := False;
      Next     : Value_Bytes     := (others => 0);
      Data     : Value_Bytes     := (others => 0);
      Sent     : Byte_Count      := 0;
      Sequence : Sequence_Number := 0;
      Left     : Block_Size      := 0;
      Waits    : Block_Size      := 0;
      Waited   : Execution_Count := 0;
      Since    : Execution_Count := Execution_Count'Last;
      Gap      : Turns           := 1;
      Apart    : Turns           := 1;
      Seen     : Event_Count     := 0;
   end record;
   --  Next: the newest value, if Has_Next. Data: the value of the transfer, of
   --  which Sent bytes have gone. Sequence: the number of the next segment.
   --  Left: segments until the next flow control, 0 where none is awaited.
   --  Waited: executions for which flow control has been awaited. Since:
   --  executions since the last segment. Gap: the distance before the next
   --  segment, Apart: that between the segments of a block. Seen: the flow
   --  controls that have been read.

   type Transfer_Fault is
     (None, Timed_Out, Overflowed, Waited_Too_Often, Wrong_Flow);
   --  The reason why a transfer ended before all of its value had gone.

   function Executions
     (Separation : Microseconds; Row : Row_Period) return Turns
   is (if Separation = 0
       then 1
       else
         (Execution_Count (Separation) + Execution_Count (Row) - 1)
         / Execution_Count (Row) + 1)
   with Global => null;
   --  Executions that lie further apart than Separation, even if the first one
   --  is as late as possible and the last one is early.

   procedure Give (State : in out Sender; Item : Value_Bytes)
   with
     Global => null,
     Post   =>
       State.Has_Next
       and then State.Next = Item
       and then State.Phase = State'Old.Phase
       and then State.Data = State'Old.Data
       and then State.Sent = State'Old.Sent;
   --  A value to send. It replaces a value that waits. A transfer that has
   --  begun continues.

   procedure Count
     (State : in out Sender;
      S     : Setting;
      Flow  : Flow_Notice;
      Fault : out Transfer_Fault)
   with
     Global => null,
     Post   =>
       (if State'Old.Phase in Starting | Sending
        then Fault = None and then State.Phase = State'Old.Phase)
       and then
         (if State'Old.Phase = Awaiting_Flow
            and then Flow.Count = State'Old.Seen
          then
            State.Phase in Awaiting_Flow | Idle
            and then (Fault = Timed_Out) = (State.Phase = Idle))
       and then
         (if State'Old.Phase in Starting .. Sending
          then
            State.Data = State'Old.Data and then State.Sent = State'Old.Sent)
       and then (if Fault /= None then State.Phase = Idle);
   --  The row has ended an execution: read flow control, give up, or begin
   --  with the value that waits.

   function Is_Due (State : Sender; S : Setting) return Boolean
   is (State.Since >= S.Distance
       and then State.Since >= State.Gap
       and then
         (State.Phase = Starting
          or else
            (State.Phase = Sending and then State.Sent < S.Length)))
   with Global => null;
   --  Does a segment go at the end of this execution?

   function Carried (State : Sender; S : Setting) return Byte_Count
   is (if State.Phase = Starting
       then (if S.Length <= 7 then S.Length else 6)
       else Natural'Min (7, S.Length - State.Sent))
   with Global => null, Pre => Is_Due (State, S);
   --  The number of bytes of the value in that segment.

   function First_Data (State : Sender; S : Setting) return Byte_Index
   is (if State.Phase = Starting and then S.Length > 7 then 2 else 1)
   with Global => null;
   --  The position of these bytes in the segment.

   function First_Sent (State : Sender) return Byte_Count
   is (if State.Phase = Starting then 0 else State.Sent)
   with Global => null;
   --  The position of these bytes in the value.

   function Next_Segment
     (State : Sender; S : Setting) return Interfaces.Unsigned_64
   with
     Global => null,
     Pre    => Is_Due (State, S),
     Post   =>
       (for all I in Byte_Index =>
          (if I in First_Data (State, S)
                .. First_Data (State, S) + Carried (State, S) - 1
           then
             Octet_Of (Next_Segment'Result, I)
             = State.Data
                 (First_Sent (State) + I - First_Data (State, S))))
       and then
         (if State.Phase = Sending
          then
            Octet_Of (Next_Segment'Result, 0)
            = 16#20# + Octet (State.Sequence));
   --  The data of that segment, which has eight bytes.

   procedure Record_Sent (State : in out Sender; S : Setting)
   with
     Global => null,
     Pre    => Is_Due (State, S),
     Post   =>
       State.Data = State'Old.Data
       and then State.Since = 0
       and then
         State.Sent = First_Sent (State'Old) + Carried (State'Old, S)
       and then
         (State.Phase = Idle) = (State.Sent = S.Length)
       and then
         (if State'Old.Phase = Sending
          then State.Sequence = State'Old.Sequence + 1)
       and then State.Phase /= Starting;
   --  The controller has taken the segment.

end Ravenchart.Can.Iso_Tp.Senders;
