--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Slcan.Frame_Lines
  with SPARK_Mode
is

   function Image (Value : Digit_Value) return Byte_Value
   is (if Value < 10 then Byte_Value (Character'Pos ('0') + Value)
       else Byte_Value (Character'Pos ('A') + (Value - 10)))
   with
     Global => null,
     Post   =>
       Is_Digit (Image'Result) and then Digit (Image'Result) = Value;
   --  The digit with this value.

   procedure Put_Byte
     (Line : in out Line_Bytes; Place : Positive; B : Byte_Value)
   with
     Global => null,
     Pre    => Place < Line_Limit,
     Post   =>
       Are_Digits_Of (Line (Place), Line (Place + 1), B)
       and then
         (for all I in Line_Bytes'Range =>
            (if I not in Place .. Place + 1
             then Line (I) = Line'Old (I)));
   --  The digits of one byte of data, the first one at Place.

   procedure Lemma_Same_Bytes
     (Line   : Line_Bytes;
      Start  : Data_Start;
      Length : Fd_Frames.Fd_Length;
      A, B   : Fd_Frames.Fd_Bytes)
   with
     Ghost,
     Global => null,
     Pre    =>
       Holds (Line, Start, Length, A) and then Holds (Line, Start, Length, B),
     Post   => (for all I in 0 .. Length - 1 => A (I) = B (I));
   --  The digits encode one sequence of bytes only.

   procedure Lemma_Holds
     (Line   : Line_Bytes;
      Start  : Data_Start;
      Length : Fd_Frames.Fd_Length;
      A, B   : Fd_Frames.Fd_Bytes)
   with
     Ghost,
     Global => null,
     Pre    =>
       Holds (Line, Start, Length, A)
       and then (for all I in 0 .. Length - 1 => A (I) = B (I)),
     Post   => Holds (Line, Start, Length, B);
   --  Bytes behind the first Length do not matter.

   function Bytes_In
     (Line   : Line_Bytes;
      Start  : Data_Start;
      Length : Fd_Frames.Fd_Length) return Fd_Frames.Fd_Bytes
   with
     Global => null,
     Pre    =>
       (for all I in Start .. Start + 2 * Length - 1 => Is_Digit (Line (I))),
     Post   => Holds (Line, Start, Length, Bytes_In'Result);
   --  The bytes whose digits begin at Start.

   procedure Put_Bytes
     (Line   : in out Line_Bytes;
      Start  : Data_Start;
      Length : Fd_Frames.Fd_Length;
      Bytes  : Fd_Frames.Fd_Bytes)
   with
     Global => null,
     Post   =>
       Holds (Line, Start, Length, Bytes)
       and then
         (for all I in Start .. Start + 2 * Length - 1 =>
            Is_Digit (Line (I)))
       and then
         (for all I in 1 .. Start - 1 => Line (I) = Line'Old (I));
   --  The digits of the first Length bytes, from Start on.

   procedure Lemma_Word
     (F : Fd_Frames.Fd_Frame; Length : Data_Length; I : Byte_Index)
   with
     Ghost,
     Global => null,
     Pre    => F.Length = Length and then I < Length,
     Post   =>
       Byte_Value
         (Interfaces.Shift_Right
            (Fd_Frames.Word (F, 0) and Mask (Length), 8 * I)
          and 16#FF#)
       = Fd_Frames.Byte (F, I);
   --  A byte of the word is the same byte of the frame.

   procedure Lemma_Bytes (F : Fd_Frames.Fd_Frame; Plain : Frame)
   with
     Ghost,
     Global => null,
     Pre    =>
       F.Length = Plain.Length
       and then Payload (Plain)
         = (Fd_Frames.Word (F, 0) and Mask (Plain.Length)),
     Post   =>
       (for all I in 0 .. Plain.Length - 1 =>
          Byte (Plain, I) = Fd_Frames.Byte (F, I));
   --  The same for the frame that carries the word.

   function Nibble (Id : Line_Number; Place : Byte_Index) return Line_Number
   is ((case Place is
          when 0 => Id,
          when 1 => Id / 16#10#,
          when 2 => Id / 16#100#,
          when 3 => Id / 16#1000#,
          when 4 => Id / 16#1_0000#,
          when 5 => Id / 16#10_0000#,
          when 6 => Id / 16#100_0000#,
          when 7 => Id / 16#1000_0000#) mod 16)
   with Global => null, Post => Nibble'Result <= 15;
   --  The digit with the weight 16**Place.

   procedure Lemma_Number (Id : Line_Number)
   with
     Ghost,
     Global => null,
     Post   =>
       (if Id < 2**12
        then 16#100# * Nibble (Id, 2) + 16#10# * Nibble (Id, 1)
             + Nibble (Id, 0)
             = Id)
       and then
         16#1000_0000# * Nibble (Id, 7) + 16#100_0000# * Nibble (Id, 6)
         + 16#10_0000# * Nibble (Id, 5) + 16#1_0000# * Nibble (Id, 4)
         + 16#1000# * Nibble (Id, 3) + 16#100# * Nibble (Id, 2)
         + 16#10# * Nibble (Id, 1) + Nibble (Id, 0)
         = Id;
   --  A number is the sum of its digits.

   procedure Lemma_Digits
     (Line : Line_Bytes; Format : Frame_Format; Id : Line_Number)
   with
     Ghost,
     Global => null,
     Pre    =>
       Id <= (if Format = Standard then 2**11 - 1 else 2**29 - 1)
       and then All_Digits (Line, 1 + Id_Digits (Format))
       and then
         (for all I in 2 .. 1 + Id_Digits (Format) =>
            Value (Line (I)) = Nibble (Id, 1 + Id_Digits (Format) - I)),
     Post   => Number (Line, Format) = Id;
   --  The digits of a number are read as this number.

   procedure Put_Id
     (Line : in out Line_Bytes; F : Any_Frames.Any_Frame)
   with
     Global => null,
     Post   =>
       Line (1) = Line'Old (1)
       and then All_Digits (Line, 1 + Id_Digits (Any_Frames.Format (F)))
       and then Number (Line, Any_Frames.Format (F))
         = Line_Number (Any_Frames.Id (F));
   --  The digits of the identifier.

   --------------
   -- Put_Byte --
   --------------

   procedure Put_Byte
     (Line : in out Line_Bytes; Place : Positive; B : Byte_Value) is
   begin
      Line (Place)     := Image (Natural (B) / 16);
      Line (Place + 1) := Image (Natural (B) mod 16);
   end Put_Byte;

   ----------------------
   -- Lemma_Same_Bytes --
   ----------------------

   procedure Lemma_Same_Bytes
     (Line   : Line_Bytes;
      Start  : Data_Start;
      Length : Fd_Frames.Fd_Length;
      A, B   : Fd_Frames.Fd_Bytes) is
   begin
      pragma Assert
        (Holds (Line, Start, Length, A)
         and then Holds (Line, Start, Length, B));
   end Lemma_Same_Bytes;

   -----------------
   -- Lemma_Holds --
   -----------------

   procedure Lemma_Holds
     (Line   : Line_Bytes;
      Start  : Data_Start;
      Length : Fd_Frames.Fd_Length;
      A, B   : Fd_Frames.Fd_Bytes) is
   begin
      pragma Assert (Holds (Line, Start, Length, A));
      pragma Assert (for all I in 0 .. Length - 1 => A (I) = B (I));
   end Lemma_Holds;

   --------------
   -- Bytes_In --
   --------------

   function Bytes_In
     (Line   : Line_Bytes;
      Start  : Data_Start;
      Length : Fd_Frames.Fd_Length) return Fd_Frames.Fd_Bytes
   is
      Result : Fd_Frames.Fd_Bytes := (others => 0);
   begin
      for I in 0 .. Length - 1 loop
         Result (I) :=
           Byte_Of (Line (Start + 2 * I), Line (Start + 2 * I + 1));
         pragma Loop_Invariant
           (for all J in 0 .. I =>
              Are_Digits_Of
                (Line (Start + 2 * J), Line (Start + 2 * J + 1),
                 Result (J)));
      end loop;
      return Result;
   end Bytes_In;

   ---------------
   -- Put_Bytes --
   ---------------

   procedure Put_Bytes
     (Line   : in out Line_Bytes;
      Start  : Data_Start;
      Length : Fd_Frames.Fd_Length;
      Bytes  : Fd_Frames.Fd_Bytes) is
   begin
      for I in 0 .. Length - 1 loop
         Put_Byte (Line, Start + 2 * I, Bytes (I));
         pragma Loop_Invariant
           (for all J in 1 .. Start - 1 => Line (J) = Line'Loop_Entry (J));
         pragma Loop_Invariant
           (for all J in Start .. Start + 2 * I + 1 => Is_Digit (Line (J)));
         pragma Loop_Invariant
           (for all J in 0 .. I =>
              Are_Digits_Of
                (Line (Start + 2 * J), Line (Start + 2 * J + 1),
                 Bytes (J)));
      end loop;
   end Put_Bytes;

   ----------------
   -- Lemma_Word --
   ----------------

   procedure Lemma_Word
     (F : Fd_Frames.Fd_Frame; Length : Data_Length; I : Byte_Index) is
   begin
      pragma Assert (F.Length = Length and then I < Length);
   end Lemma_Word;

   -----------------
   -- Lemma_Bytes --
   -----------------

   procedure Lemma_Bytes (F : Fd_Frames.Fd_Frame; Plain : Frame) is
   begin
      for I in 0 .. Plain.Length - 1 loop
         Lemma_Word (F, Plain.Length, I);
         pragma Loop_Invariant
           (for all J in 0 .. I => Byte (Plain, J) = Fd_Frames.Byte (F, J));
      end loop;
   end Lemma_Bytes;

   ------------------
   -- Lemma_Number --
   ------------------

   procedure Lemma_Number (Id : Line_Number) is
   begin
      pragma Assert (Id / 16#100# = Id / 16#10# / 16);
      pragma Assert (Id / 16#1000# = Id / 16#100# / 16);
      pragma Assert (Id / 16#1_0000# = Id / 16#1000# / 16);
      pragma Assert (Id / 16#10_0000# = Id / 16#1_0000# / 16);
      pragma Assert (Id / 16#100_0000# = Id / 16#10_0000# / 16);
      pragma Assert (Id / 16#1000_0000# = Id / 16#100_0000# / 16);
   end Lemma_Number;

   ------------------
   -- Lemma_Digits --
   ------------------

   procedure Lemma_Digits
     (Line : Line_Bytes; Format : Frame_Format; Id : Line_Number) is
   begin
      Lemma_Number (Id);
      if Format = Standard then
         pragma Assert
           (Value (Line (2)) = Nibble (Id, 2)
            and then Value (Line (3)) = Nibble (Id, 1)
            and then Value (Line (4)) = Nibble (Id, 0));
      else
         pragma Assert
           (Value (Line (2)) = Nibble (Id, 7)
            and then Value (Line (3)) = Nibble (Id, 6)
            and then Value (Line (4)) = Nibble (Id, 5)
            and then Value (Line (5)) = Nibble (Id, 4)
            and then Value (Line (6)) = Nibble (Id, 3)
            and then Value (Line (7)) = Nibble (Id, 2)
            and then Value (Line (8)) = Nibble (Id, 1)
            and then Value (Line (9)) = Nibble (Id, 0));
      end if;
   end Lemma_Digits;

   ------------
   -- Put_Id --
   ------------

   procedure Put_Id
     (Line : in out Line_Bytes; F : Any_Frames.Any_Frame)
   is
      Count : constant Positive := Id_Digits (Any_Frames.Format (F));
      Id    : constant Line_Number := Line_Number (Any_Frames.Id (F));
   begin
      for I in 1 .. Count loop
         Line (1 + I) := Image (Digit_Value (Nibble (Id, Count - I)));
         pragma Loop_Invariant
           (Line (1) = Line'Loop_Entry (1)
            and then
              (for all J in 2 .. 1 + I =>
                 Is_Digit (Line (J))
                 and then
                   Value (Line (J)) = Nibble (Id, Count + 1 - J)));
      end loop;
      Lemma_Digits (Line, Any_Frames.Format (F), Id);
   end Put_Id;

   --------------
   -- Frame_In --
   --------------

   function Frame_In
     (Line : Line_Bytes; Count : Content_Length) return Reading
   is
      Letter   : constant Byte_Value := Line (1);
      Format   : constant Frame_Format := Format_Of (Letter);
      Behind   : constant Positive := Header (Format) + 1;
      Length   : Fd_Frames.Fd_Length;
      Id       : Line_Number;
      Bytes    : Fd_Frames.Fd_Bytes;
      Flexible : Fd_Frames.Fd_Frame;
      Plain    : Frame;
      F        : Any_Frames.Any_Frame;
   begin
      if Count < Header (Format)
        or else not Is_Letter (Letter)
        or else not All_Digits (Line, Count)
      then
         return (others => <>);
      end if;
      Id     := Number (Line, Format);
      Length := Length_At (Line, Header (Format));
      if Id > Line_Number (Identifier'Last)
        or else not Fits (Identifier (Id), Format)
        or else (Length > 8 and then not Is_Fd (Letter))
        or else Count /=
          Header (Format) + (if Kind_Of (Letter) = Data
                             then 2 * Length else 0)
      then
         return (others => <>);
      end if;
      if Kind_Of (Letter) = Remote then
         F := Any_Frames.To_Any
           (Remote_Frame (Identifier (Id), Format, Length));
         pragma Assert (Carried (F) = 0);
      else
         Bytes    := Bytes_In (Line, Behind, Length);
         Flexible := Fd_Frames.Fd_Data_Frame
           (Identifier (Id), Format, Length, Bytes,
            (if Letter in Standard_Switched | Extended_Switched
             then Fd_Frames.Switched_Rate
             else Fd_Frames.Constant_Rate));
         if Is_Fd (Letter) then
            F := Any_Frames.To_Any (Flexible);
         else
            Plain := Data_Frame
              (Identifier (Id), Format, Length,
               Fd_Frames.Word (Flexible, 0));
            Lemma_Bytes (Flexible, Plain);
            F := Any_Frames.To_Any (Plain);
         end if;
         pragma Assert (Carried (F) = Length);
         Lemma_Holds (Line, Behind, Length, Bytes, Any_Frames.Bytes (F));
      end if;
      pragma Assert (Any_Frames.Format (F) = Format);
      pragma Assert (Holds (Line, Behind, Carried (F), Any_Frames.Bytes (F)));
      return (Found => True, F => F);
   end Frame_In;

   -----------
   -- Write --
   -----------

   procedure Write
     (F     : Any_Frames.Any_Frame;
      Line  : out Line_Bytes;
      Count : out Content_Length)
   is
      Format : constant Frame_Format := Any_Frames.Format (F);
   begin
      Line     := (others => 0);
      Line (1) := Letter_Of (F);
      Put_Id (Line, F);
      Line (Header (Format)) :=
        Image (Digit_Value (Fd_Frames.Code (Length (F))));
      Put_Bytes (Line, Header (Format) + 1, Carried (F), Any_Frames.Bytes (F));
      Count := Header (Format) + 2 * Carried (F);
   end Write;

   ---------------------
   -- Lemma_Read_Back --
   ---------------------

   procedure Lemma_Read_Back
     (Line  : Line_Bytes;
      Count : Content_Length;
      F     : Any_Frames.Any_Frame)
   is
      Read : constant Reading := Frame_In (Line, Count);
   begin
      pragma Assert
        (Is_Letter (Letter_Of (F))
         and then Format_Of (Letter_Of (F)) = Any_Frames.Format (F)
         and then Is_Fd (Letter_Of (F)) = (F.Family = Any_Frames.Flexible));
      pragma Assert (Is_Frame_Line (Line, Count));
      pragma Assert
        (Any_Frames.Format (Read.F) = Any_Frames.Format (F)
         and then Length (Read.F) = Length (F)
         and then Carried (Read.F) = Carried (F));
      Lemma_Same_Bytes
        (Line, Header (Any_Frames.Format (F)) + 1, Carried (F),
         Any_Frames.Bytes (Read.F), Any_Frames.Bytes (F));
   end Lemma_Read_Back;

end Ravenchart.Can.Slcan.Frame_Lines;
