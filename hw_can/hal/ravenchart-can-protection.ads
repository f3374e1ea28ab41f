--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  End-to-end protection of messages: a counter and a CRC over the data and an
--  identifier of the message, which is not in the frame as a whole. The
--  receiver finds corrupted, repeated, lost, inserted and masqueraded frames.
--
--  Guarantees   a frame is Usable only if its CRC is right for its data and
--               its data identifier. Its counter must also be 1 to Max_Delta
--               after that of the last frame whose CRC was right
--  Tasking      none: one task owns each Sender and each Receiver
--  Timing       linear in the length of the frame
--
--  AUTOSAR FO PRS_E2EProtocol: profiles 1, 2, 5 and 11, header at byte 0.
--  Protect is E2E_PxxProtect. Check is E2E_P05Check and E2E_P11Check for all
--  profiles. The first frame has the status Initial, as in profiles 1 and 2,
--  and Sync is their SyncCounterInit.

with Interfaces;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fd_Frames;

package Ravenchart.Can.Protection
  with SPARK_Mode, Pure
is
   use type Any_Frames.Any_Frame;
   use type Any_Frames.Frame_Family;
   use type Interfaces.Unsigned_8;
   use type Interfaces.Unsigned_16;

   type Profile is (Profile_1, Profile_2, Profile_5, Profile_11);

   type Id_Mode is (Both, Alternating, Nibble);
   --  The bytes of the data identifier in the CRC, in profiles 1 and 11. Both:
   --  both (variants 1A and 11A). Alternating: the low one with even counters,
   --  the high one with odd counters (1B). Nibble: the low one and a 0; the
   --  low half of the high one is in the frame (1C and 11C).

   type Id_List is array (Interfaces.Unsigned_8 range 0 .. 15)
     of Interfaces.Unsigned_8;
   --  Data identifiers by counter, in profile 2.

   subtype Counter_Value is Interfaces.Unsigned_8;

   function Last_Counter (P : Profile) return Counter_Value
   is (case P is
         when Profile_1 | Profile_11 => 14,
         when Profile_2              => 15,
         when Profile_5              => 255)
   with Global => null;
   --  The last value of the counter, which 0 follows.

   function Header_Length (P : Profile) return Positive
   is (if P = Profile_5 then 3 else 2)
   with Global => null;
   --  Bytes that hold the CRC and the counter; in profiles 1, 2 and 11 the
   --  high half of the second one is data, except in mode Nibble.

   subtype Delta_Limit is Counter_Value range 1 .. 254;

   subtype Sync_Count is Counter_Value range 1 .. 14;

   type Setting is record
      Kind      : Profile := Profile_5;
      Mode      : Id_Mode := Both;
      Data_Id   : Interfaces.Unsigned_16 := 0;
      Ids       : Id_List := (others => 0);
      Length    : Fd_Frames.Fd_Length := 8;
      Max_Delta : Delta_Limit := 1;
      Sync      : Sync_Count := 1;
   end record
   with
     Predicate =>
       Length >= Header_Length (Kind)
       and then Max_Delta < Last_Counter (Kind)
       and then (if Kind = Profile_11 then Mode in Both | Nibble);
   --  Ids belongs to profile 2, Data_Id to the others. Length: bytes of the
   --  frame. Max_Delta: 1 where no frame may be lost. Sync: frames in sequence
   --  after a wrong one until frames are used again.

   function Counter
     (F : Any_Frames.Any_Frame; P : Profile) return Counter_Value
   is (if P = Profile_5
       then Any_Frames.Byte (F, 2)
       else Any_Frames.Byte (F, 1) and 16#0F#)
   with Global => null;
   --  The counter in the frame.

   function Crc_Field
     (F : Any_Frames.Any_Frame; P : Profile) return Interfaces.Unsigned_16
   is (if P = Profile_5
       then
         Interfaces.Unsigned_16 (Any_Frames.Byte (F, 0))
         or Interfaces.Shift_Left
              (Interfaces.Unsigned_16 (Any_Frames.Byte (F, 1)), 8)
       else Interfaces.Unsigned_16 (Any_Frames.Byte (F, 0)))
   with Global => null;
   --  The CRC in the frame, low byte first.

   function High_Id (S : Setting) return Interfaces.Unsigned_8
   is (Interfaces.Unsigned_8 (Interfaces.Shift_Right (S.Data_Id, 8)))
   with Global => null;

   function Low_Id (S : Setting) return Interfaces.Unsigned_8
   is (Interfaces.Unsigned_8 (S.Data_Id and 16#FF#))
   with Global => null;

   function Has_Nibble (S : Setting) return Boolean
   is (S.Mode = Nibble and then S.Kind in Profile_1 | Profile_11)
   with Global => null;
   --  Is a part of the data identifier in the frame?

   function Shows_Nibble
     (F : Any_Frames.Any_Frame; S : Setting) return Boolean
   is (if Has_Nibble (S)
       then
         (Any_Frames.Byte (F, 1) and 16#F0#)
         = Interfaces.Shift_Left (High_Id (S), 4))
   with Global => null;
   --  Is that part the one of this message?

   function Crc
     (S : Setting; Item : Fd_Frames.Fd_Bytes; Count : Counter_Value)
      return Interfaces.Unsigned_16
   with
     Global => null,
     Pre    => Count <= Last_Counter (S.Kind),
     Post   => (if S.Kind /= Profile_5 then Crc'Result <= 16#FF#);
   --  The CRC over Item and over the data identifier. Item holds the frame's
   --  data of S.Length bytes, without the bytes of the CRC itself. The data
   --  identifier comes before the data in profiles 1 and 11, and after them in
   --  profiles 2 and 5.

   function Is_Intact
     (F : Any_Frames.Any_Frame; S : Setting) return Boolean
   is (Any_Frames.Carries (F, F.Family, S.Length)
       and then Counter (F, S.Kind) <= Last_Counter (S.Kind)
       and then Shows_Nibble (F, S)
       and then
         Crc_Field (F, S.Kind)
         = Crc (S, Any_Frames.Bytes (F), Counter (F, S.Kind)))
   with Global => null;
   --  Is it a frame of this message with a right CRC?

   function Header_Mask (S : Setting) return Interfaces.Unsigned_64
   is (case S.Kind is
         when Profile_5              => 16#FF_FFFF#,
         when Profile_2              => 16#0FFF#,
         when Profile_1 | Profile_11 =>
           (if Has_Nibble (S) then 16#FFFF# else 16#0FFF#))
   with Global => null;
   --  The bits of the header, in the first eight bytes as one word.

   function First_Word
     (F : Any_Frames.Any_Frame) return Interfaces.Unsigned_64
   is (if F.Family = Any_Frames.Classic
       then Any_Frames.Payload (F)
       else Fd_Frames.Word (F.Fd, 0))
   with Global => null;
   --  The first eight bytes as one word, byte 0 lowest.

   function Has_Same_Data
     (F, G : Any_Frames.Any_Frame; S : Setting) return Boolean
   is (Any_Frames.Carries (G, F.Family, S.Length)
       and then Any_Frames.Id (F) = Any_Frames.Id (G)
       and then Any_Frames.Format (F) = Any_Frames.Format (G)
       and then
         (First_Word (F) and not Header_Mask (S))
         = (First_Word (G) and not Header_Mask (S))
       and then
         (for all I in 8 .. Fd_Frames.Fd_Index'Last =>
            Any_Frames.Byte (F, I) = Any_Frames.Byte (G, I)))
   with Ghost, Global => null;
   --  Frames that differ only in the header.

   function Protected_Frame
     (F : Any_Frames.Any_Frame; S : Setting; Count : Counter_Value)
      return Any_Frames.Any_Frame
   with
     Global => null,
     Pre    =>
       Any_Frames.Carries (F, F.Family, S.Length)
       and then Count <= Last_Counter (S.Kind),
     Post   =>
       Is_Intact (Protected_Frame'Result, S)
       and then Counter (Protected_Frame'Result, S.Kind) = Count
       and then Has_Same_Data (F, Protected_Frame'Result, S);
   --  F with its header.

   type Sender is record
      Next : Counter_Value := 0;
   end record;
   --  The counter of the next frame.

   function Current (State : Sender; P : Profile) return Counter_Value
   is (if State.Next <= Last_Counter (P) then State.Next else 0)
   with Global => null;

   function Successor
     (Count : Counter_Value; P : Profile) return Counter_Value
   is (if Count < Last_Counter (P) then Count + 1 else 0)
   with Global => null;

   procedure Protect
     (State : in out Sender; S : Setting; F : in out Any_Frames.Any_Frame)
   with
     Global => null,
     Pre    => Any_Frames.Carries (F, F.Family, S.Length),
     Post   =>
       F = Protected_Frame (F'Old, S, Current (State'Old, S.Kind))
       and then
         State.Next = Successor (Current (State'Old, S.Kind), S.Kind)
       and then Is_Intact (F, S)
       and then Has_Same_Data (F'Old, F, S);
   --  Write the header, and count.

   type Status is
     (Ok, Ok_Some_Lost, Initial, Synchronizing, Repeated, Wrong_Sequence,
      Error);
   --  Ok: the next frame. Ok_Some_Lost: at most Max_Delta - 1 frames are
   --  missing before it. Initial: the first frame, without one to compare it
   --  with. Synchronizing: in sequence, but fewer than Sync since a wrong one.
   --  Repeated: the counter of the last one. Wrong_Sequence: any other
   --  counter. Error: not intact.

   subtype Usable is Status range Ok .. Ok_Some_Lost;
   --  The statuses with which the data may be used.

   subtype Fault is Status range Repeated .. Error;
   --  The statuses that a correct sender never causes on a faultless bus.

   type Receiver is record
      Has_Last : Boolean := False;
      Last     : Counter_Value := 0;
      Awaited  : Counter_Value := 0;
   end record;
   --  Last: counter of the last intact frame, if there was one. Awaited:
   --  frames in sequence that are not used yet.

   function Distance
     (From, To : Counter_Value; P : Profile) return Integer
   is (if Integer (To) >= Integer (From)
       then Integer (To) - Integer (From)
       else Integer (To) - Integer (From) + Integer (Last_Counter (P)) + 1)
   with Global => null;
   --  Frames from one counter to the other.

   function Is_In_Sequence
     (State : Receiver; S : Setting; Count : Counter_Value) return Boolean
   is (State.Has_Last
       and then
         Distance (State.Last, Count, S.Kind) in 1 .. Integer (S.Max_Delta))
   with Global => null;

   function Status_Of
     (State : Receiver; S : Setting; F : Any_Frames.Any_Frame) return Status
   is (if not Is_Intact (F, S)
       then Error
       elsif not State.Has_Last
       then Initial
       elsif Distance (State.Last, Counter (F, S.Kind), S.Kind) = 0
       then Repeated
       elsif not Is_In_Sequence (State, S, Counter (F, S.Kind))
       then Wrong_Sequence
       elsif State.Awaited > 0
       then Synchronizing
       elsif Distance (State.Last, Counter (F, S.Kind), S.Kind) = 1
       then Ok
       else Ok_Some_Lost)
   with
     Global => null,
     Post   =>
       (if Status_Of'Result in Usable
        then
          Is_Intact (F, S)
          and then Is_In_Sequence (State, S, Counter (F, S.Kind)));
   --  The status of a frame that arrives now.

   procedure Check
     (State  : in out Receiver;
      S      : Setting;
      F      : Any_Frames.Any_Frame;
      Result : out Status)
   with
     Global => null,
     Post   =>
       Result = Status_Of (State'Old, S, F)
       and then
         State =
           (case Result is
              when Error | Repeated         => State'Old,
              when Ok | Ok_Some_Lost        =>
                (True, Counter (F, S.Kind), 0),
              when Synchronizing            =>
                (True, Counter (F, S.Kind), State'Old.Awaited - 1),
              when Initial | Wrong_Sequence =>
                (True, Counter (F, S.Kind), S.Sync - 1));
   --  The status of a frame, and the state of the receiver after it.

   procedure Lemma_Late_Not_Used
     (State : Receiver;
      S     : Setting;
      F     : Any_Frames.Any_Frame;
      Age   : Natural)
   with
     Ghost,
     Global => null,
     Pre    =>
       State.Has_Last
       and then
         Age <= Integer (Last_Counter (S.Kind)) - Integer (S.Max_Delta)
       and then
         Integer (Counter (F, S.Kind)) =
           Integer (State.Last) - Age
           + (if Age <= Integer (State.Last)
              then 0
              else Integer (Last_Counter (S.Kind)) + 1),
     Post   => Status_Of (State, S, F) not in Usable;
   --  A copy of one of the last frames, or a frame that was delayed behind
   --  them, is not used. This holds for the last one (Age = 0) and for any one
   --  within the range of the counter.

end Ravenchart.Can.Protection;
