--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The receiver of values in segments (ISO 15765-2), segment by segment.
--
--  Guarantees   a value is Complete only when all its bytes have come, in
--               order and with no more than Timeout between two segments. No
--               byte is written outside its room; a longer value is refused
--  Tasking      none: the task of the reception owns the Receiver
--  Timing       linear in the room for a value
--
--  Timeout is N_Cr. It counts from the segment before, so that it includes the
--  time until flow control is sent. Take finds a segment that is late, Give_Up
--  a segment that does not come.

package Ravenchart.Can.Iso_Tp.Receivers
  with SPARK_Mode, Pure
is
   use type Fd_Frames.Fd_Bytes;

   type Setting is record
      Length   : Value_Length         := 8;
      Block    : Block_Size           := 0;
      Timeout  : Positive_Nanoseconds := 1;
      Patience : Positive_Nanoseconds := 1;
   end record;
   --  Length: bytes of a value. Block: segments that are requested at once.
   --  Patience: the silence that ends a transfer, which is Timeout and the
   --  longest time from the Stamp of a segment until it is taken.

   type Receiver is record
      Is_Open  : Boolean         := False;
      Data     : Value_Bytes     := (others => 0);
      Got      : Byte_Count      := 0;
      Sequence : Sequence_Number := 0;
      Left     : Block_Size      := 0;
      Last     : Nanoseconds     := 0;
   end record;
   --  Is_Open: a transfer is under way. Got: bytes of Data that have come.
   --  Sequence: the number of the next segment. Left: segments until flow
   --  control is sent, 0 where none is. Last: the time of the last segment.

   type Outcome is
     (Ignored, Taken, Complete, Restarted, Timed_Out, Wrong_Sequence,
      Wrong_Length);
   --  Taken: a segment of a value that is not complete. Restarted: the same,
   --  and the value before it is given up. Timed_Out: the segment came too
   --  late, and the value is given up. Wrong_Length: a value of another
   --  length.

   subtype Fault is Outcome range Restarted .. Wrong_Length;

   type Answer is (No_Answer, Ask_For_More, Refuse);
   --  The flow control to send: none, continue to send, or overflow.

   procedure Take
     (State   : in out Receiver;
      S       : Setting;
      Payload : Interfaces.Unsigned_64;
      Length  : Data_Length;
      Stamp   : Nanoseconds;
      Result  : out Outcome;
      Reply   : out Answer)
   with
     Global => null,
     Post   =>
       (if Result = Complete
        then State.Got = S.Length and then not State.Is_Open)
       and then
         (if Result in Taken | Restarted
          then State.Is_Open and then State.Got < S.Length)
       and then
         (if Result in Ignored | Wrong_Length | Timed_Out | Wrong_Sequence
          then State.Data = State'Old.Data)
       and then
         (if Result in Timed_Out | Wrong_Sequence then not State.Is_Open)
       and then
         (if Result in Taken | Complete
            and then Decoded (Payload, Length).Kind = Consecutive
          then
            State'Old.Is_Open
            and then
              Decoded (Payload, Length).Sequence = State'Old.Sequence
            and then Stamp - State'Old.Last <= S.Timeout
            and then State.Sequence = State'Old.Sequence + 1
            and then
              State.Got =
                Natural'Min (State'Old.Got + 7, S.Length)
            and then
              (for all I in Fd_Frames.Fd_Index =>
                 State.Data (I) =
                   (if I in State'Old.Got .. State.Got - 1
                    then Octet_Of (Payload, I - State'Old.Got + 1)
                    else State'Old.Data (I))))
       and then
         (if Result in Taken | Restarted
            and then Decoded (Payload, Length).Kind = First
          then
            State.Got = 6
            and then State.Sequence = 1
            and then
              (for all I in 0 .. 5 =>
                 State.Data (I) = Octet_Of (Payload, I + 2)))
       and then (if Reply = Ask_For_More then State.Is_Open)
       and then (if Reply = Refuse then Result = Wrong_Length);
   --  A frame of Length bytes has come at Stamp.

   procedure Give_Up
     (State   : in out Receiver;
      S       : Setting;
      Now     : Nanoseconds;
      Expired : out Boolean)
   with
     Global => null,
     Post   =>
       Expired
         = (State'Old.Is_Open and then Now - State'Old.Last > S.Patience)
       and then
         State.Is_Open = (State'Old.Is_Open and then not Expired)
       and then State.Data = State'Old.Data
       and then State.Got = State'Old.Got
       and then State.Sequence = State'Old.Sequence
       and then State.Left = State'Old.Left
       and then State.Last = State'Old.Last;
   --  End the transfer if no segment has come for Patience until Now.

end Ravenchart.Can.Iso_Tp.Receivers;
