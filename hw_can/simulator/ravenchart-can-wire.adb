--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces;
with Ravenchart.Can.Arbitration;
with Ravenchart.Can.Crcs;

package body Ravenchart.Can.Wire
  with SPARK_Mode
is
   use type Crcs.Crc_Kind;
   use type Fd_Frames.Sender_State;
   use type Interfaces.Unsigned_32;
   use type Levels.Level;

   Most_Exposed : constant := 553;
   --  Exposed bits of the longest frame.

   Most_Fixed : constant := 45;
   --  The other bits of the longest frame: check field and tail.

   subtype Equal_Bits is Natural range 0 .. 5;
   --  The number of equal bits at the end of the bits so far.

   type Writer is record
      Picture : Image;
      Exposed : Bit_Count := 0;
      Fixed   : Bit_Count := 0;
      Run     : Equal_Bits := 0;
      Last    : Levels.Level := Levels.Recessive;
      Kind    : Crcs.Crc_Kind := Crcs.Crc_15;
      Check   : Crcs.Register := 0;
   end record;
   --  A frame that is being written: the number of bits exposed to stuffing,
   --  the number of the others, and the register of its CRC.

   function Written (W : Writer) return Natural
   is (W.Exposed + W.Picture.Stuffed + W.Fixed)
   with Global => null;
   --  All bits so far.

   function Is_Sound (W : Writer) return Boolean
   is (W.Exposed <= Most_Exposed
       and then W.Fixed <= Most_Fixed
       and then
         (if W.Exposed = 0 then W.Picture.Stuffed = 0 and then W.Run = 0
          else W.Run >= 1
            and then 4 * W.Picture.Stuffed + W.Run <= W.Exposed))
   with
     Global => null,
     Post   => (if Is_Sound'Result then Written (W) <= Longest);
   --  Each stuff bit has used four exposed bits, and each bit of the run one.

   function Is_Followed
     (Before, After : Writer; Exposed, Fixed : Bit_Count) return Boolean
   is (After.Exposed = Before.Exposed + Exposed
       and then After.Fixed = Before.Fixed + Fixed
       and then After.Kind = Before.Kind
       and then After.Picture.Stuffed >= Before.Picture.Stuffed
       and then After.Picture.Ends = Before.Picture.Ends)
   with
     Ghost,
     Global => null;
   --  Does After follow from Before by so many bits?

   procedure Stuff (W : in out Writer)
   with
     Global => null,
     Pre    => Is_Sound (W) and then W.Run = 5,
     Post   =>
       Is_Sound (W)
       and then Is_Followed (W'Old, W, 0, 0)
       and then W.Picture.Stuffed = W.Picture.Stuffed'Old + 1
       and then W.Run = 1;
   --  The dynamic stuff bit behind five equal bits.

   procedure Put (W : in out Writer; L : Levels.Level)
   with
     Global => null,
     Pre    => Is_Sound (W) and then W.Exposed < Most_Exposed,
     Post   =>
       Is_Sound (W)
       and then Is_Followed (W'Old, W, 1, 0)
       and then
         (if W.Exposed >= 2
          then 4 * W.Picture.Stuffed + 2 <= W.Exposed);
   --  Write an exposed bit, after the stuff bit that is due before it.

   procedure Put_Number
     (W : in out Writer; Value : Interfaces.Unsigned_32; Width : Positive)
   with
     Global => null,
     Pre    =>
       Is_Sound (W)
       and then Width <= 32
       and then W.Exposed <= Most_Exposed - Width,
     Post   =>
       Is_Sound (W)
       and then Is_Followed (W'Old, W, Width, 0)
       and then
         (if W.Exposed >= 2
          then 4 * W.Picture.Stuffed + 2 <= W.Exposed);
   --  Write the lowest Width bits of Value, exposed, the highest of them
   --  first.

   procedure Put_Fixed (W : in out Writer; L : Levels.Level)
   with
     Global => null,
     Pre    => Is_Sound (W) and then W.Fixed < Most_Fixed,
     Post   =>
       Is_Sound (W)
       and then Is_Followed (W'Old, W, 0, 1)
       and then W.Picture.Stuffed = W.Picture.Stuffed'Old;
   --  Write a bit that stuffing ignores.

   procedure Close (W : in out Writer; Ended : Field)
   with
     Global => null,
     Pre    => Is_Sound (W),
     Post   =>
       Is_Sound (W)
       and then W.Exposed = W.Exposed'Old
       and then W.Fixed = W.Fixed'Old
       and then W.Kind = W.Kind'Old
       and then W.Picture.Stuffed = W.Picture.Stuffed'Old
       and then
         (for all F in Field =>
            W.Picture.Ends (F) =
              (if F = Ended then Written (W) else W.Picture.Ends'Old (F)));
   --  The field Ended ends with the bit written last.

   procedure Put_Head (W : in out Writer; C : Arbitration.Contender)
   with
     Global => null,
     Pre    => Is_Sound (W) and then W.Exposed = 0 and then W.Fixed = 0,
     Post   =>
       Is_Sound (W)
       and then W.Exposed = Head_Bits (C.Format)
       and then W.Fixed = 0
       and then W.Kind = W.Kind'Old;
   --  Write the start of frame and the bits that Arbitration compares.

   procedure Put_Check (W : in out Writer)
   with
     Global => null,
     Pre    =>
       Is_Sound (W)
       and then W.Fixed = 0
       and then W.Kind /= Crcs.Crc_15,
     Post   =>
       Is_Sound (W)
       and then Is_Followed
         (W'Old, W, 0, (if W.Kind = Crcs.Crc_17 then 27 else 32))
       and then W.Picture.Stuffed = W.Picture.Stuffed'Old;
   --  The check field of CAN FD: the number of stuff bits modulo 8 as Gray
   --  code with a bit of even parity, then the CRC. A fixed stuff bit comes
   --  first and after each four bits.

   procedure Put_Recessive
     (W : in out Writer; Count : Positive; Ended : Field)
   with
     Global => null,
     Pre    =>
       Is_Sound (W)
       and then Count <= 7
       and then W.Fixed <= Most_Fixed - Count,
     Post   =>
       Is_Sound (W)
       and then W.Exposed = W.Exposed'Old
       and then W.Fixed = W.Fixed'Old + Count
       and then W.Picture.Stuffed = W.Picture.Stuffed'Old
       and then
         (for all F in Field =>
            W.Picture.Ends (F) =
              (if F = Ended then Written (W) else W.Picture.Ends'Old (F)));
   --  A field of recessive bits.

   procedure Put_Tail (W : in out Writer)
   with
     Global => null,
     Pre    => Is_Sound (W) and then W.Fixed <= Most_Fixed - Tail_Bits,
     Post   =>
       Length (W.Picture) = Written (W)'Old + Tail_Bits
       and then W.Picture.Stuffed = W.Picture.Stuffed'Old
       and then
         (for all F in Arbitration_Field .. Check_Field =>
            W.Picture.Ends (F) = W.Picture.Ends'Old (F));
   --  Everything behind the check field.

   function Stuff_Code (Count : Bit_Count) return Interfaces.Unsigned_32
   is (case Count mod 8 is
         when 0      => 2#0000#,
         when 1      => 2#0011#,
         when 2      => 2#0110#,
         when 3      => 2#0101#,
         when 4      => 2#1100#,
         when 5      => 2#1111#,
         when 6      => 2#1010#,
         when others => 2#1001#)
   with Global => null;
   --  The stuff count of the check field for so many stuff bits.

   function Bit
     (Value : Interfaces.Unsigned_32; Place : Natural) return Levels.Level
   is (Levels.To_Level ((Interfaces.Shift_Right (Value, Place) and 1) = 1))
   with
     Global => null,
     Pre    => Place < 32;
   --  The bit of Value with the weight 2**Place.

   -----------
   -- Stuff --
   -----------

   procedure Stuff (W : in out Writer) is
   begin
      W.Last                           := Levels.Inverse (W.Last);
      W.Picture.Bits (Written (W) + 1) := W.Last;
      W.Picture.Stuffed                := W.Picture.Stuffed + 1;
      W.Run                            := 1;
      if W.Kind /= Crcs.Crc_15 then
         W.Check := Crcs.Next (W.Kind, W.Check, W.Last);
      end if;
   end Stuff;

   ---------
   -- Put --
   ---------

   procedure Put (W : in out Writer; L : Levels.Level) is
   begin
      if W.Run = 5 then
         Stuff (W);
      end if;
      W.Picture.Bits (Written (W) + 1) := L;
      W.Exposed                        := W.Exposed + 1;
      W.Run                            :=
        (if W.Run > 0 and then L = W.Last then W.Run + 1 else 1);
      W.Last                           := L;
      W.Check                          := Crcs.Next (W.Kind, W.Check, L);
   end Put;

   ----------------
   -- Put_Number --
   ----------------

   procedure Put_Number
     (W : in out Writer; Value : Interfaces.Unsigned_32; Width : Positive)
   is
      Before : constant Writer := W with Ghost;
   begin
      for I in reverse 0 .. Width - 1 loop
         Put (W, Bit (Value, I));
         pragma Loop_Invariant
           (Is_Sound (W)
            and then Is_Followed (Before, W, Width - I, 0)
            and then
              (if W.Exposed >= 2
               then 4 * W.Picture.Stuffed + 2 <= W.Exposed));
      end loop;
   end Put_Number;

   ---------------
   -- Put_Fixed --
   ---------------

   procedure Put_Fixed (W : in out Writer; L : Levels.Level) is
   begin
      W.Picture.Bits (Written (W) + 1) := L;
      W.Fixed                          := W.Fixed + 1;
      W.Last                           := L;
   end Put_Fixed;

   -----------
   -- Close --
   -----------

   procedure Close (W : in out Writer; Ended : Field) is
   begin
      W.Picture.Ends (Ended) := Written (W);
   end Close;

   --------------
   -- Put_Head --
   --------------

   procedure Put_Head (W : in out Writer; C : Arbitration.Contender) is
      Rank : constant Arbitration.Rank := Arbitration.Rank_Of (C);
   begin
      W.Check := Crcs.Start (W.Kind);
      Put (W, Levels.Dominant);
      for P in 1 .. Arbitration.Compared (C.Format) loop
         Put (W, Arbitration.Level_At (Rank, P));
         pragma Loop_Invariant
           (Is_Sound (W)
            and then W.Exposed = P + 1
            and then W.Fixed = 0
            and then W.Kind = W.Kind'Loop_Entry);
      end loop;
      Close (W, Arbitration_Field);
   end Put_Head;

   ---------------
   -- Put_Check --
   ---------------

   procedure Put_Check (W : in out Writer) is
      Before : constant Writer := W with Ghost;
      Code   : constant Interfaces.Unsigned_32 :=
        Stuff_Code (W.Picture.Stuffed);
      Width  : constant Positive := Crcs.Width (W.Kind);
   begin
      Put_Fixed (W, Levels.Inverse (W.Last));
      for I in reverse 0 .. 3 loop
         Put_Fixed (W, Bit (Code, I));
         W.Check := Crcs.Next (W.Kind, W.Check, W.Last);
         pragma Loop_Invariant
           (Is_Sound (W)
            and then Is_Followed (Before, W, 0, 5 - I)
            and then W.Picture.Stuffed = Before.Picture.Stuffed);
      end loop;
      for I in 0 .. Width - 1 loop
         if I mod 4 = 0 then
            Put_Fixed (W, Levels.Inverse (W.Last));
         end if;
         Put_Fixed (W, Bit (W.Check, Width - 1 - I));
         pragma Loop_Invariant
           (Is_Sound (W)
            and then Is_Followed (Before, W, 0, 7 + I + I / 4)
            and then W.Picture.Stuffed = Before.Picture.Stuffed);
      end loop;
   end Put_Check;

   -------------------
   -- Put_Recessive --
   -------------------

   procedure Put_Recessive
     (W : in out Writer; Count : Positive; Ended : Field)
   is
      Before : constant Writer := W with Ghost;
   begin
      for I in 1 .. Count loop
         Put_Fixed (W, Levels.Recessive);
         pragma Loop_Invariant
           (Is_Sound (W)
            and then Is_Followed (Before, W, 0, I)
            and then W.Picture.Stuffed = Before.Picture.Stuffed);
      end loop;
      Close (W, Ended);
   end Put_Recessive;

   --------------
   -- Put_Tail --
   --------------

   procedure Put_Tail (W : in out Writer) is
   begin
      Put_Recessive (W, 1, Check_Delimiter);
      Put_Recessive (W, 1, Acknowledgement_Slot);
      Put_Recessive (W, 1, Acknowledgement_Delimiter);
      Put_Recessive (W, 7, End_Of_Frame);
      Put_Recessive (W, 3, Intermission);
   end Put_Tail;

   -------------
   -- To_Wire --
   -------------

   function To_Wire (F : Frame) return Image is
      W : Writer;
   begin
      Put_Head (W, (Id => F.Id, Format => F.Format, Kind => F.Kind));
      Put_Number (W, 0, (if F.Format = Can.Standard then 1 else 2));
      Close (W, Format_Bits);
      Put_Number (W, Interfaces.Unsigned_32 (F.Length), 4);
      Close (W, Length_Bits);
      if F.Kind = Data then
         for I in 0 .. F.Length - 1 loop
            Put_Number (W, Interfaces.Unsigned_32 (Byte (F, I)), 8);
            pragma Loop_Invariant
              (Is_Sound (W)
               and then Is_Followed (W'Loop_Entry, W, 8 * (I + 1), 0));
         end loop;
      end if;
      Close (W, Data_Field);
      Put_Number (W, W.Check, 15);
      if W.Run = 5 then
         Stuff (W);
      end if;
      Close (W, Check_Field);
      Put_Tail (W);
      return W.Picture;
   end To_Wire;

   function To_Wire (F : Fd_Frames.Fd_Frame) return Image is
      W : Writer;
   begin
      W.Kind := (if F.Length <= 16 then Crcs.Crc_17 else Crcs.Crc_21);
      Put_Head (W, (Id => F.Id, Format => F.Format, Kind => Data));
      Put_Number
        (W,
         (if F.Rate = Fd_Frames.Switched_Rate then 2#101# else 2#100#),
         3);
      Close (W, Format_Bits);
      Put_Number
        (W,
         (if F.Sender = Fd_Frames.Passive_Sender then 16 else 0)
         + Interfaces.Unsigned_32 (Fd_Frames.Code (F.Length)),
         5);
      Close (W, Length_Bits);
      for I in 0 .. F.Length - 1 loop
         Put_Number
           (W, Interfaces.Unsigned_32 (Fd_Frames.Byte (F, I)), 8);
         pragma Loop_Invariant
           (Is_Sound (W)
            and then Is_Followed (W'Loop_Entry, W, 8 * (I + 1), 0)
            and then 4 * W.Picture.Stuffed + 2 <= W.Exposed);
      end loop;
      Close (W, Data_Field);
      Put_Check (W);
      Close (W, Check_Field);
      Put_Tail (W);
      return W.Picture;
   end To_Wire;

end Ravenchart.Can.Wire;
