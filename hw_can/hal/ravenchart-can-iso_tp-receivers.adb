--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Iso_Tp.Receivers
  with SPARK_Mode
is

   function Merged
     (Data    : Value_Bytes;
      Payload : Interfaces.Unsigned_64;
      Begins  : Byte_Index;
      From    : Byte_Count;
      Count   : Byte_Count) return Value_Bytes
   with
     Pre  =>
       Begins >= 1
       and then Count <= 8 - Begins
       and then From <= 64 - Count,
     Post =>
       (for all I in Fd_Frames.Fd_Index =>
          Merged'Result (I) =
            (if I in From .. From + Count - 1
             then Octet_Of (Payload, I - From + Begins)
             else Data (I)));
   --  Data with Count bytes of a segment from From on.

   ------------
   -- Merged --
   ------------

   function Merged
     (Data    : Value_Bytes;
      Payload : Interfaces.Unsigned_64;
      Begins  : Byte_Index;
      From    : Byte_Count;
      Count   : Byte_Count) return Value_Bytes
   is
      Result : Value_Bytes := Data;
   begin
      for I in 0 .. Count - 1 loop
         Result (From + I) := Octet_Of (Payload, Begins + I);
         pragma Loop_Invariant
           (for all J in Fd_Frames.Fd_Index =>
              Result (J) =
                (if J in From .. From + I
                 then Octet_Of (Payload, J - From + Begins)
                 else Data (J)));
      end loop;
      return Result;
   end Merged;

   procedure Begin_Value
     (State   : in out Receiver;
      S       : Setting;
      Payload : Interfaces.Unsigned_64;
      Length  : Announced_Length;
      Stamp   : Nanoseconds;
      Result  : out Outcome;
      Reply   : out Answer)
   with
     Post =>
       Result in Taken | Restarted | Wrong_Length
       and then (if Reply = Ask_For_More then State.Is_Open)
       and then (if Reply = Refuse then Result = Wrong_Length)
       and then
         (if Result = Wrong_Length
          then State.Data = State'Old.Data
          else
            State.Is_Open
            and then State.Got = 6
            and then State.Got < S.Length
            and then State.Sequence = 1
            and then
              (for all I in 0 .. 5 =>
                 State.Data (I) = Octet_Of (Payload, I + 2)));
   --  A first frame has come.

   procedure Continue_Value
     (State    : in out Receiver;
      S        : Setting;
      Payload  : Interfaces.Unsigned_64;
      Length   : Data_Length;
      Sequence : Sequence_Number;
      Stamp    : Nanoseconds;
      Result   : out Outcome;
      Reply    : out Answer)
   with
     Pre  => State.Is_Open and then Length >= 2,
     Post =>
       Result in Taken | Complete | Timed_Out | Wrong_Sequence | Ignored
       and then (if Reply = Ask_For_More then State.Is_Open)
       and then Reply /= Refuse
       and then
         (if Result in Ignored | Timed_Out | Wrong_Sequence
          then State.Data = State'Old.Data)
       and then
         (if Result in Timed_Out | Wrong_Sequence then not State.Is_Open)
       and then
         (if Result = Complete
          then State.Got = S.Length and then not State.Is_Open)
       and then
         (if Result = Taken
          then State.Is_Open and then State.Got < S.Length)
       and then
         (if Result in Taken | Complete
          then
            Sequence = State'Old.Sequence
            and then Stamp - State'Old.Last <= S.Timeout
            and then State.Sequence = State'Old.Sequence + 1
            and then
              State.Got = Natural'Min (State'Old.Got + 7, S.Length)
            and then
              (for all I in Fd_Frames.Fd_Index =>
                 State.Data (I) =
                   (if I in State'Old.Got .. State.Got - 1
                    then Octet_Of (Payload, I - State'Old.Got + 1)
                    else State'Old.Data (I))));
   --  A consecutive frame has come.

   -----------------
   -- Begin_Value --
   -----------------

   procedure Begin_Value
     (State   : in out Receiver;
      S       : Setting;
      Payload : Interfaces.Unsigned_64;
      Length  : Announced_Length;
      Stamp   : Nanoseconds;
      Result  : out Outcome;
      Reply   : out Answer) is
   begin
      if Length /= S.Length or else Length < 8 then
         Result := Wrong_Length;
         Reply  := (if Length > S.Length then Refuse else No_Answer);
         State.Is_Open := False;
         return;
      end if;
      Result         := (if State.Is_Open then Restarted else Taken);
      Reply          := Ask_For_More;
      State.Data     := Merged (State.Data, Payload, 2, 0, 6);
      State.Is_Open  := True;
      State.Got      := 6;
      State.Sequence := 1;
      State.Left     := S.Block;
      State.Last     := Stamp;
   end Begin_Value;

   --------------------
   -- Continue_Value --
   --------------------

   procedure Continue_Value
     (State    : in out Receiver;
      S        : Setting;
      Payload  : Interfaces.Unsigned_64;
      Length   : Data_Length;
      Sequence : Sequence_Number;
      Stamp    : Nanoseconds;
      Result   : out Outcome;
      Reply    : out Answer)
   is
      Count : Byte_Count;
   begin
      Reply := No_Answer;
      if State.Got >= S.Length then
         State.Is_Open := False;
         Result        := Wrong_Sequence;
         return;
      end if;
      Count := Natural'Min (7, S.Length - State.Got);
      if Stamp - State.Last > S.Timeout then
         State.Is_Open := False;
         Result        := Timed_Out;
      elsif Sequence /= State.Sequence then
         State.Is_Open := False;
         Result        := Wrong_Sequence;
      elsif Length <= Count then
         Result := Ignored;
      else
         State.Data     :=
           Merged (State.Data, Payload, 1, State.Got, Count);
         State.Got      := State.Got + Count;
         State.Sequence := State.Sequence + 1;
         State.Last     := Stamp;
         if State.Got = S.Length then
            State.Is_Open := False;
            Result        := Complete;
         else
            Result := Taken;
            if State.Left = 1 then
               State.Left := S.Block;
               Reply      := Ask_For_More;
            else
               State.Left := Natural'Max (State.Left, 1) - 1;
            end if;
         end if;
      end if;
   end Continue_Value;

   ----------
   -- Take --
   ----------

   procedure Take
     (State   : in out Receiver;
      S       : Setting;
      Payload : Interfaces.Unsigned_64;
      Length  : Data_Length;
      Stamp   : Nanoseconds;
      Result  : out Outcome;
      Reply   : out Answer)
   is
      Found : constant Segment := Decoded (Payload, Length);
   begin
      case Found.Kind is
         when Single                 =>
            Reply         := No_Answer;
            State.Is_Open := False;
            if Found.Length = S.Length then
               State.Data :=
                 Merged (State.Data, Payload, 1, 0, Found.Length);
               State.Got  := Found.Length;
               Result     := Complete;
            else
               Result := Wrong_Length;
            end if;
         when First                  =>
            Begin_Value
              (State, S, Payload, Found.Length, Stamp, Result, Reply);
         when Consecutive            =>
            if State.Is_Open then
               Continue_Value
                 (State, S, Payload, Length, Found.Sequence, Stamp,
                  Result, Reply);
            else
               Result := Ignored;
               Reply  := No_Answer;
            end if;
         when Flow_Control | Unknown =>
            Result := Ignored;
            Reply  := No_Answer;
      end case;
   end Take;

   -------------
   -- Give_Up --
   -------------

   procedure Give_Up
     (State   : in out Receiver;
      S       : Setting;
      Now     : Nanoseconds;
      Expired : out Boolean) is
   begin
      Expired := State.Is_Open and then Now - State.Last > S.Patience;
      if Expired then
         State.Is_Open := False;
      end if;
   end Give_Up;

end Ravenchart.Can.Iso_Tp.Receivers;
