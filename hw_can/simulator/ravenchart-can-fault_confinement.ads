--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Fault confinement: the error counters of one node, and the state that
--  follows from them.
--
--  Guarantees   the state follows from the counters; each event moves one
--               counter as its rule states; a bus-off node comes back after
--               128 sequences of 11 recessive bits, not a bit earlier
--  Tasking      none: one owner for each Node
--  Timing       constant
--
--  ISO 11898-1 (2015), fault confinement. The rules have the numbers of the
--  Bosch CAN Specification 2.0 (1991), part B, chapter 8, rules 1 to 12.

with Ravenchart.Can.Levels;

package Ravenchart.Can.Fault_Confinement
  with SPARK_Mode, Pure
is
   use type Levels.Level;

   subtype Connected_State is
     Controller_State range Error_Active .. Bus_Off;
   --  The states of a node on the bus.

   type Fault_Event is
     (Receiver_Error,
      Dominant_After_Receiver_Flag,
      Transmitter_Error,
      Unanswered,
      Stuff_Bit_Overruled,
      Transmitter_Flag_Error,
      Receiver_Flag_Error,
      Transmitter_Held_Dominant,
      Receiver_Held_Dominant,
      Transmitted,
      Received);
   --  Rules 1 to 8. Unanswered: no acknowledgement, and the sender read no
   --  dominant bit during its passive flag (3, exception 1).
   --  Stuff_Bit_Overruled: a recessive stuff bit, read dominant during
   --  arbitration (3, exception 2). Flag_Error: a bit error in an active
   --  flag or an overload flag (4, 5). Held_Dominant: 14 dominant bits from
   --  the start of an active or overload flag, 8 behind a passive one, and
   --  each 8 after those (6).

   type Node is private
   with Default_Initial_Condition =>
     State (Node) = Error_Active
     and then Transmit_Errors (Node) = 0
     and then Receive_Errors (Node) = 0;
   --  A node as it joins the bus.

   function Transmit_Errors (N : Node) return Error_Count
   with Global => null;
   --  The transmit error counter (TEC); 256 means bus-off.

   function Receive_Errors (N : Node) return Error_Count
   with Global => null;
   --  The receive error counter (REC); it stops at 256.

   function State_For
     (Transmit, Receive : Error_Count) return Connected_State
   is (if Transmit > 255 then Bus_Off
       elsif Transmit > 127 or else Receive > 127 then Error_Passive
       else Error_Active)
   with Global => null;
   --  Rules 9, 10 and 11.

   function State (N : Node) return Connected_State
   with
     Global => null,
     Post   =>
       State'Result = State_For (Transmit_Errors (N), Receive_Errors (N));
   --  The present state of N.

   function Raised
     (Count : Error_Count; By : Error_Count) return Error_Count
   is (if Count > Error_Count'Last - By then Error_Count'Last
       else Count + By)
   with Global => null;
   --  Count and By more, at most the last value.

   function Transmit_Rule
     (Event : Fault_Event;
      State : Connected_State;
      Count : Error_Count) return Error_Count
   is (case Event is
         when Transmitter_Error
            | Transmitter_Flag_Error
            | Transmitter_Held_Dominant => Raised (Count, 8),
         when Unanswered                =>
           (if State = Error_Passive then Count else Raised (Count, 8)),
         when Transmitted               =>
           (if Count = 0 then 0 else Count - 1),
         when Stuff_Bit_Overruled
            | Receiver_Error
            | Dominant_After_Receiver_Flag
            | Receiver_Flag_Error
            | Receiver_Held_Dominant
            | Received                  => Count)
   with Global => null;
   --  Rules 3, 4, 6 and 7 for the transmit error counter.

   function Receive_Rule
     (Event : Fault_Event; Count : Error_Count) return Error_Count
   is (case Event is
         when Receiver_Error            => Raised (Count, 1),
         when Dominant_After_Receiver_Flag
            | Receiver_Flag_Error
            | Receiver_Held_Dominant    => Raised (Count, 8),
         when Received                  =>
           (if Count > 127 then 127
            elsif Count = 0 then 0
            else Count - 1),
         when Transmitter_Error
            | Unanswered
            | Stuff_Bit_Overruled
            | Transmitter_Flag_Error
            | Transmitter_Held_Dominant
            | Transmitted               => Count)
   with Global => null;
   --  Rules 1, 2, 5, 6 and 8 for the receive error counter. Rule 8 allows 119
   --  to 127; this implementation sets 127.

   Sequence_Bits : constant := 11;
   --  Recessive bits in a row that make one sequence of the recovery.

   Sequences : constant := 128;
   --  Sequences that make a recovery.

   Whole_Recovery : constant := Sequence_Bits * Sequences;
   --  1408 bits.

   subtype Recovery_Bits is Positive range 1 .. Whole_Recovery;
   --  The bits that are left of a recovery.

   function Bits_To_Recovery (N : Node) return Recovery_Bits
   with Global => null;
   --  The recessive bits in a row after which N is back, if it is bus-off.

   procedure Count (N : in out Node; Event : Fault_Event)
   with
     Global => null,
     Pre    => State (N) /= Bus_Off,
     Post   =>
       Transmit_Errors (N) =
         Transmit_Rule (Event, State (N'Old), Transmit_Errors (N'Old))
       and then Receive_Errors (N) =
         Receive_Rule (Event, Receive_Errors (N'Old))
       and then Bits_To_Recovery (N) = Whole_Recovery
       and then
         (if State (N) = Bus_Off then State (N'Old) = Error_Passive)
       and then
         (if Event = Unanswered and then Transmit_Errors (N'Old) <= 135
          then Transmit_Errors (N) <= 135);
   --  Count one event. A node never goes from error-active to bus-off at once,
   --  and a node alone on the bus never becomes bus-off.

   function Sequence_Restarted (Left : Recovery_Bits) return Recovery_Bits
   is ((Left + Sequence_Bits - 1) / Sequence_Bits * Sequence_Bits)
   with Global => null;
   --  Left, without the sequence that has begun.

   procedure Monitor (N : in out Node; Bus : Levels.Level)
   with
     Global => null,
     Pre    => State (N) = Bus_Off,
     Post   =>
       (if Bus = Levels.Dominant
        then State (N) = Bus_Off
          and then Bits_To_Recovery (N) =
            Sequence_Restarted (Bits_To_Recovery (N'Old))
        elsif Bits_To_Recovery (N'Old) > 1
        then State (N) = Bus_Off
          and then Bits_To_Recovery (N) = Bits_To_Recovery (N'Old) - 1
        else State (N) = Error_Active
          and then Transmit_Errors (N) = 0
          and then Receive_Errors (N) = 0
          and then Bits_To_Recovery (N) = Whole_Recovery);
   --  Count one bit on the bus while bus-off (rule 12). ISO 11898-1 (2015)
   --  lets the user request the recovery first; without a request this is not
   --  called.

private

   type Node is record
      Transmit : Error_Count := 0;
      Receive  : Error_Count := 0;
      Left     : Recovery_Bits := Whole_Recovery;
   end record;

   function Transmit_Errors (N : Node) return Error_Count
   is (N.Transmit);

   function Receive_Errors (N : Node) return Error_Count
   is (N.Receive);

   function State (N : Node) return Connected_State
   is (State_For (N.Transmit, N.Receive));

   function Bits_To_Recovery (N : Node) return Recovery_Bits
   is (N.Left);

end Ravenchart.Can.Fault_Confinement;
