--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Authentication of messages on CAN FD. A frame ends with the low bytes of a
--  freshness value and the first bytes of a message authentication code (MAC)
--  over the data identifier, the data and the whole freshness value. The
--  receiver finds forged, altered and replayed frames.
--
--  Guarantees   a sender never takes a freshness value twice. A frame is
--               Verified only if it ends with the MAC of its data and of a
--               value that is greater than all values verified before
--  Tasking      none: one task owns each Freshness_State
--  Timing       linear in the length of the frame; the comparison of MACs
--               takes the same time for equal and different ones
--  Assumptions  the MAC is computed elsewhere: without the key, no sender
--               finds a frame that is Verified
--
--  AUTOSAR FO PRS_SecOcProtocol: the data to authenticate, the truncation and
--  the reconstruction of the freshness value; without a header, one attempt of
--  verification for each frame.

with Interfaces;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fd_Frames;

package Ravenchart.Can.Authentication
  with SPARK_Mode, Pure
is
   use type Any_Frames.Frame_Family;
   use type Fd_Frames.Bit_Rate_Use;
   use type Interfaces.Unsigned_8;

   subtype Freshness_Value is Interfaces.Unsigned_64;
   --  The number of a frame under its key and data identifier.

   subtype Freshness_Size is Positive range 1 .. 8;
   --  The number of its bytes in the frame.

   subtype Mac_Size is Positive range 3 .. 16;
   --  Bytes of the MAC in the frame.

   type Setting is record
      Data_Id         : Interfaces.Unsigned_16 := 0;
      Length          : Fd_Frames.Fd_Length := 64;
      Freshness_Bytes : Freshness_Size := 8;
      Mac_Bytes       : Mac_Size := 8;
   end record
   with Predicate => Length >= Freshness_Bytes + Mac_Bytes;
   --  Length: bytes of the frame.

   subtype Data_Size is Natural range 0 .. 60;

   function Data_Length (S : Setting) return Data_Size
   is (S.Length - S.Freshness_Bytes - S.Mac_Bytes)
   with Global => null;
   --  Bytes before the freshness value.

   -----------------
   -- Computation --
   -----------------

   subtype Input_Size is Natural range 0 .. 70;

   subtype Input_Index is Natural range 0 .. 69;

   type Input_Bytes is array (Input_Index) of Interfaces.Unsigned_8;

   type Mac_Input is record
      Length : Input_Size := 0;
      Bytes  : Input_Bytes := (others => 0);
   end record;
   --  The input of the MAC: the first Length bytes.

   subtype Tag_Index is Natural range 0 .. 15;

   type Tag_Bytes is array (Tag_Index) of Interfaces.Unsigned_8;

   type Mac_Answer is record
      Is_Known : Boolean := False;
      Tag      : Tag_Bytes := (others => 0);
   end record;
   --  A MAC, its most significant byte first. When it is not known, no frame
   --  is sent and no received frame is used.

   ------------------
   -- In the frame --
   ------------------

   function Is_Whole
     (F : Any_Frames.Any_Frame; S : Setting) return Boolean
   is (Any_Frames.Carries (F, Any_Frames.Flexible, S.Length))
   with Global => null;
   --  Is it a CAN FD frame of this length?

   function Mask (S : Setting) return Freshness_Value
   is (case S.Freshness_Bytes is
         when 1 => 16#FF#,
         when 2 => 16#FFFF#,
         when 3 => 16#FF_FFFF#,
         when 4 => 16#FFFF_FFFF#,
         when 5 => 16#FF_FFFF_FFFF#,
         when 6 => 16#FFFF_FFFF_FFFF#,
         when 7 => 16#FF_FFFF_FFFF_FFFF#,
         when 8 => 16#FFFF_FFFF_FFFF_FFFF#)
   with Global => null;
   --  The bits of a freshness value that are in the frame.

   subtype Octet_Index is Natural range 0 .. 7;

   function Octet
     (Value : Freshness_Value; K : Octet_Index) return Interfaces.Unsigned_8
   is (Interfaces.Unsigned_8
         (Interfaces.Shift_Right (Value, 8 * K) and 16#FF#))
   with Global => null;
   --  One byte of a freshness value, the lowest one with K = 0.

   function Shown_Octet
     (F : Any_Frames.Any_Frame; S : Setting; K : Octet_Index)
      return Freshness_Value
   is (if K < S.Freshness_Bytes
       then Freshness_Value
              (Any_Frames.Byte (F, S.Length - S.Mac_Bytes - 1 - K))
       else 0)
   with Global => null;
   --  One byte of the freshness value in the frame; 0 for a byte that is not
   --  there.

   function Shown
     (F : Any_Frames.Any_Frame; S : Setting) return Freshness_Value
   is (Shown_Octet (F, S, 0)
       or Interfaces.Shift_Left (Shown_Octet (F, S, 1), 8)
       or Interfaces.Shift_Left (Shown_Octet (F, S, 2), 16)
       or Interfaces.Shift_Left (Shown_Octet (F, S, 3), 24)
       or Interfaces.Shift_Left (Shown_Octet (F, S, 4), 32)
       or Interfaces.Shift_Left (Shown_Octet (F, S, 5), 40)
       or Interfaces.Shift_Left (Shown_Octet (F, S, 6), 48)
       or Interfaces.Shift_Left (Shown_Octet (F, S, 7), 56))
   with Global => null;
   --  The part of the freshness value that the frame carries, highest byte
   --  first.

   function Shows_Tag
     (F : Any_Frames.Any_Frame; S : Setting; Tag : Tag_Bytes) return Boolean
   is (for all I in 0 .. S.Mac_Bytes - 1 =>
         Any_Frames.Byte (F, S.Length - S.Mac_Bytes + I) = Tag (I))
   with Global => null;
   --  Does F end with the first bytes of this MAC?

   function Input_Of
     (F : Any_Frames.Any_Frame; S : Setting; Value : Freshness_Value)
      return Mac_Input
   with
     Global => null,
     Post   =>
       Input_Of'Result.Length = Data_Length (S) + 10
       and then Input_Of'Result.Bytes (0)
         = Octet (Freshness_Value (S.Data_Id), 1)
       and then Input_Of'Result.Bytes (1)
         = Octet (Freshness_Value (S.Data_Id), 0)
       and then
         (for all I in Input_Index =>
            (if I in 2 .. Data_Length (S) + 1
             then Input_Of'Result.Bytes (I) = Any_Frames.Byte (F, I - 2)
             elsif I in Data_Length (S) + 2 .. Data_Length (S) + 9
             then
               Input_Of'Result.Bytes (I)
               = Octet (Value, Data_Length (S) + 9 - I)
             elsif I > Data_Length (S) + 9
             then Input_Of'Result.Bytes (I) = 0));
   --  The data to authenticate: data identifier, data, freshness value, each
   --  number with its highest byte first.

   function Is_Authentic
     (F      : Any_Frames.Any_Frame;
      S      : Setting;
      Value  : Freshness_Value;
      Answer : Mac_Answer) return Boolean
   is (Is_Whole (F, S)
       and then Shown (F, S) = (Value and Mask (S))
       and then Answer.Is_Known
       and then Shows_Tag (F, S, Answer.Tag))
   with Global => null;
   --  Does F end with this freshness value and with this MAC?

   function Has_Same_Header (F, G : Any_Frames.Any_Frame) return Boolean
   is (F.Family = Any_Frames.Flexible
       and then G.Family = Any_Frames.Flexible
       and then F.Fd.Length = G.Fd.Length
       and then F.Fd.Id = G.Fd.Id
       and then F.Fd.Format = G.Fd.Format
       and then F.Fd.Rate = G.Fd.Rate)
   with Ghost, Global => null;
   --  CAN FD frames with the same length, identifier, format and bit rates.

   function Has_Same_Data
     (F, G : Any_Frames.Any_Frame; S : Setting) return Boolean
   is (Has_Same_Header (F, G)
       and then
         (for all I in 0 .. Data_Length (S) - 1 =>
            Any_Frames.Byte (F, I) = Any_Frames.Byte (G, I)))
   with Ghost, Global => null;
   --  Frames that differ only behind their data.

   -----------
   -- State --
   -----------

   type Freshness_State is record
      Is_Started : Boolean := False;
      Last       : Freshness_Value := 0;
   end record;
   --  Last: the value of the last frame that was sent or verified.

   procedure Begin_After
     (State : in out Freshness_State; Last : Freshness_Value)
   with
     Global => null,
     Post   =>
       (if State'Old.Is_Started
        then State = State'Old
        else State = (True, Last));
   --  Begin with the value after Last, unless State has begun already.

   -------------
   -- Sending --
   -------------

   procedure Take
     (State : in out Freshness_State;
      Value : out Freshness_Value;
      Taken : out Boolean)
   with
     Global => null,
     Post   =>
       State.Is_Started = State'Old.Is_Started
       and then Value = State.Last
       and then Taken = (State'Old.Last < Freshness_Value'Last)
       and then
         (if Taken
          then State.Last = State'Old.Last + 1
          else State = State'Old);
   --  The value of the next frame. No value follows Freshness_Value'Last.

   procedure Seal
     (F      : in out Any_Frames.Any_Frame;
      S      : Setting;
      Value  : Freshness_Value;
      Answer : Mac_Answer)
   with
     Global => null,
     Pre    => Is_Whole (F, S) and then Answer.Is_Known,
     Post   =>
       Is_Authentic (F, S, Value, Answer)
       and then Has_Same_Data (F'Old, F, S)
       and then Input_Of (F, S, Value) = Input_Of (F'Old, S, Value);
   --  Write the freshness value and the MAC.

   ---------------
   -- Receiving --
   ---------------

   type Status is
     (Verified, Unverified, Malformed, Not_Fresh, No_Mac, Wrong_Mac);
   --  Verified: the MAC is right, and the value may be used. Unverified:
   --  fresh, its MAC not compared yet. Malformed: wrong length or family.
   --  Not_Fresh: no possible value of the frame is greater than the last one.
   --  No_Mac: the MAC could not be computed. Wrong_Mac: the MAC of the frame
   --  differs: the frame is altered, forged, or repeated.

   procedure Reconstruct
     (State  : Freshness_State;
      S      : Setting;
      F      : Any_Frames.Any_Frame;
      Value  : out Freshness_Value;
      Result : out Status)
   with
     Global => null,
     Post   =>
       Result in Unverified | Malformed | Not_Fresh
       and then (Result = Malformed) = not Is_Whole (F, S)
       and then
         (if Result = Unverified
          then
            Value > State.Last
            and then (Value and Mask (S)) = Shown (F, S)
            and then Value - State.Last - 1 <= Mask (S)
          else Value = State.Last);
   --  The least value greater than the last one whose low bytes are those of
   --  the frame: it follows the last one by at most 2 ** (8 *
   --  Freshness_Bytes). With all eight bytes in the frame it is the value of
   --  the frame.

   procedure Verify
     (State  : in out Freshness_State;
      S      : Setting;
      F      : Any_Frames.Any_Frame;
      Value  : Freshness_Value;
      Answer : Mac_Answer;
      Result : out Status)
   with
     Global => null,
     Pre    =>
       Value > State.Last
       and then Is_Whole (F, S)
       and then (Value and Mask (S)) = Shown (F, S),
     Post   =>
       Result in Verified | No_Mac | Wrong_Mac
       and then (Result = Verified) = Is_Authentic (F, S, Value, Answer)
       and then State.Is_Started = State'Old.Is_Started
       and then
         State.Last = (if Result = Verified then Value else State.Last'Old);
   --  Compare the MAC with that of the frame. Only a Verified frame changes
   --  State.

   procedure Lemma_Least
     (State : Freshness_State;
      S     : Setting;
      F     : Any_Frames.Any_Frame;
      Value : Freshness_Value;
      Other : Freshness_Value)
   with
     Ghost,
     Global => null,
     Pre    =>
       Value > State.Last
       and then (Value and Mask (S)) = Shown (F, S)
       and then Value - State.Last - 1 <= Mask (S)
       and then Other > State.Last
       and then (Other and Mask (S)) = Shown (F, S),
     Post   => Value <= Other;
   --  No other possible value of the frame is less than the reconstructed one.

end Ravenchart.Can.Authentication;
