--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Iso_Tp.Senders
  with SPARK_Mode
is

   procedure End_Transfer (State : in out Sender)
   with
     Post =>
       State.Phase = Idle
       and then State.Data = State'Old.Data
       and then State.Sent = State'Old.Sent;
   --  End the transfer: no segment of this value follows.

   procedure Look
     (State : in out Sender;
      S     : Setting;
      Flow  : Flow_Notice;
      Fault : out Transfer_Fault)
   with
     Post =>
       State.Data = State'Old.Data
       and then State.Sent = State'Old.Sent
       and then (if Fault /= None then State.Phase = Idle);
   --  The awaited flow control has come.

   ------------------
   -- End_Transfer --
   ------------------

   procedure End_Transfer (State : in out Sender) is
   begin
      State.Phase := Idle;
   end End_Transfer;

   ----------
   -- Give --
   ----------

   procedure Give (State : in out Sender; Item : Value_Bytes) is
   begin
      State.Next     := Item;
      State.Has_Next := True;
   end Give;

   ----------
   -- Look --
   ----------

   procedure Look
     (State : in out Sender;
      S     : Setting;
      Flow  : Flow_Notice;
      Fault : out Transfer_Fault) is
   begin
      Fault := None;
      case Flow.Status is
         when Continue_To_Send =>
            State.Phase := Sending;
            State.Left  := Flow.Block;
            State.Gap   := S.Distance;
            State.Apart :=
              Turns'Max (S.Distance, Executions (Flow.Separation, S.Row));
         when Wait             =>
            if State.Waits >= S.Waits then
               End_Transfer (State);
               Fault := Waited_Too_Often;
            else
               State.Waits  := State.Waits + 1;
               State.Waited := 0;
            end if;
         when Overflow         =>
            End_Transfer (State);
            Fault := Overflowed;
         when Invalid          =>
            End_Transfer (State);
            Fault := Wrong_Flow;
      end case;
   end Look;

   -----------
   -- Count --
   -----------

   procedure Count
     (State : in out Sender;
      S     : Setting;
      Flow  : Flow_Notice;
      Fault : out Transfer_Fault) is
   begin
      Fault := None;
      if State.Since < Execution_Count'Last then
         State.Since := State.Since + 1;
      end if;
      case State.Phase is
         when Idle               =>
            if State.Has_Next then
               State.Phase    := Starting;
               State.Data     := State.Next;
               State.Has_Next := False;
               State.Sent     := 0;
               State.Gap      := S.Distance;
            end if;
         when Starting | Sending =>
            null;
         when Awaiting_Flow      =>
            if Flow.Count /= State.Seen then
               Look (State, S, Flow, Fault);
            elsif State.Waited >= S.Timeout then
               End_Transfer (State);
               Fault := Timed_Out;
            else
               State.Waited := State.Waited + 1;
            end if;
      end case;
      State.Seen := Flow.Count;
   end Count;

   ------------------
   -- Next_Segment --
   ------------------

   function Next_Segment
     (State : Sender; S : Setting) return Interfaces.Unsigned_64
   is
      Begins : constant Byte_Index := First_Data (State, S);
      From   : constant Byte_Count := First_Sent (State);
      Bytes  : constant Byte_Count := Carried (State, S);
      Result : Frame_Octets := (others => Padding);
   begin
      if State.Phase = Sending then
         Result (0) := 16#20# + Octet (State.Sequence);
      elsif S.Length <= 7 then
         Result (0) := Octet (S.Length);
      else
         Result (0) := 16#10#;
         Result (1) := Octet (S.Length);
      end if;
      for I in 0 .. Bytes - 1 loop
         Result (Begins + I) := State.Data (From + I);
         pragma Loop_Invariant
           (for all J in Byte_Index =>
              (if J in Begins .. Begins + I
               then Result (J) = State.Data (From + J - Begins)
               else Result (J) = Result'Loop_Entry (J)));
      end loop;
      pragma
        Assert
          (for all I in Byte_Index =>
             Octet_Of (Payload_Of (Result), I) = Result (I));
      return Payload_Of (Result);
   end Next_Segment;

   -----------------
   -- Record_Sent --
   -----------------

   procedure Record_Sent (State : in out Sender; S : Setting) is
      Bytes : constant Byte_Count := Carried (State, S);
   begin
      State.Since := 0;
      if State.Phase = Starting then
         State.Sent     := Bytes;
         State.Sequence := 1;
         State.Phase    := Awaiting_Flow;
         State.Waits    := 0;
         State.Waited   := 0;
      else
         State.Sent     := State.Sent + Bytes;
         State.Sequence := State.Sequence + 1;
         State.Gap      := State.Apart;
         if State.Left = 1 then
            State.Phase  := Awaiting_Flow;
            State.Waits  := 0;
            State.Waited := 0;
         end if;
         State.Left := Natural'Max (State.Left, 1) - 1;
      end if;
      if State.Sent = S.Length then
         State.Phase := Idle;
      end if;
   end Record_Sent;

end Ravenchart.Can.Iso_Tp.Senders;
