--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Frames as lines of slcan, without the carriage return: the letter, the
--  digits of the identifier, that of the length code, and those of the data.
--
--  Guarantees   a line is read as a frame if and only if it has this form; the
--               line that Write gives for a frame is read as this frame
--               (Lemma_Read_Back)
--  Tasking      none: lines are values
--  Timing       linear in the length of a line

with Ravenchart.Can.Fd_Frames;

private package Ravenchart.Can.Slcan.Frame_Lines
  with SPARK_Mode, Pure
is
   use type Fd_Frames.Bit_Rate_Use;

   subtype Byte_Value is Interfaces.Unsigned_8;

   function Code (C : Character) return Byte_Value
   is (Character'Pos (C))
   with Global => null;
   --  The ASCII code of C.

   Standard_Data     : constant Byte_Value := Character'Pos ('t');
   Standard_Remote   : constant Byte_Value := Character'Pos ('r');
   Standard_Fd       : constant Byte_Value := Character'Pos ('d');
   Standard_Switched : constant Byte_Value := Character'Pos ('b');
   Extended_Data     : constant Byte_Value := Character'Pos ('T');
   Extended_Remote   : constant Byte_Value := Character'Pos ('R');
   Extended_Fd       : constant Byte_Value := Character'Pos ('D');
   Extended_Switched : constant Byte_Value := Character'Pos ('B');
   --  The letters that the lines of frames begin with.

   function Is_Letter (B : Byte_Value) return Boolean
   is (B in Standard_Data | Standard_Remote
         | Standard_Fd | Standard_Switched
         | Extended_Data | Extended_Remote
         | Extended_Fd | Extended_Switched)
   with Global => null;
   --  Is B one of them?

   subtype Digit_Value is Natural range 0 .. 15;
   --  The value of one digit.

   function Is_Digit (B : Byte_Value) return Boolean
   is (B in Code ('0') .. Code ('9')
         | Code ('A') .. Code ('F')
         | Code ('a') .. Code ('f'))
   with Global => null;
   --  Is B a hexadecimal digit?

   function Digit (B : Byte_Value) return Digit_Value
   is (if B <= Code ('9') then Natural (B) - Character'Pos ('0')
       elsif B <= Code ('F') then Natural (B) - Character'Pos ('A') + 10
       else Natural (B) - Character'Pos ('a') + 10)
   with
     Global => null,
     Pre    => Is_Digit (B);
   --  The value of the digit B.

   function Id_Digits (Format : Frame_Format) return Positive
   is (if Format = Standard then 3 else 8)
   with Global => null;
   --  Digits of the identifier in a line.

   function Header (Format : Frame_Format) return Positive
   is (1 + Id_Digits (Format) + 1)
   with Global => null;
   --  The position of the digit of the length.

   subtype Data_Start is Positive range 6 .. 11;
   --  The position at which the digits of the data may begin.

   function All_Digits
     (Line : Line_Bytes; Count : Content_Length) return Boolean
   is (for all I in 2 .. Count => Is_Digit (Line (I)))
   with Global => null;
   --  Are there only digits behind the letter?

   type Line_Number is range 0 .. 2**32 - 1;
   --  A number of eight digits.

   function Value (B : Byte_Value) return Line_Number
   is (Line_Number (Digit (B)))
   with
     Global => null,
     Pre    => Is_Digit (B),
     Post   => Value'Result <= 15;
   --  The value of the digit B, as a part of a number.

   function Number
     (Line : Line_Bytes; Format : Frame_Format) return Line_Number
   is (if Format = Standard
       then 16#100# * Value (Line (2))
            + 16#10# * Value (Line (3))
            + Value (Line (4))
       else 16#1000_0000# * Value (Line (2))
            + 16#100_0000# * Value (Line (3))
            + 16#10_0000# * Value (Line (4))
            + 16#1_0000# * Value (Line (5))
            + 16#1000# * Value (Line (6))
            + 16#100# * Value (Line (7))
            + 16#10# * Value (Line (8))
            + Value (Line (9)))
   with
     Global => null,
     Pre    => All_Digits (Line, 1 + Id_Digits (Format));
   --  The number behind the letter, its highest digit first.

   function Byte_Of (High, Low : Byte_Value) return Byte_Value
   is (16 * Byte_Value (Digit (High)) + Byte_Value (Digit (Low)))
   with
     Global => null,
     Pre    => Is_Digit (High) and then Is_Digit (Low),
     Post   =>
       Natural (Byte_Of'Result) = 16 * Digit (High) + Digit (Low);
   --  The byte whose digits are High and Low.

   function Are_Digits_Of (High, Low, B : Byte_Value) return Boolean
   is (Is_Digit (High)
       and then Is_Digit (Low)
       and then B = Byte_Of (High, Low))
   with
     Ghost,
     Global => null;
   --  Are High and Low the digits of B?

   function Holds
     (Line   : Line_Bytes;
      Start  : Data_Start;
      Length : Fd_Frames.Fd_Length;
      Bytes  : Fd_Frames.Fd_Bytes) return Boolean
   is (for all I in 0 .. Length - 1 =>
         Are_Digits_Of
           (High => Line (Start + 2 * I),
            Low  => Line (Start + 2 * I + 1),
            B    => Bytes (I)))
   with
     Ghost,
     Global => null;
   --  Are the digits from Start on those of the first Length bytes?

   function Format_Of (Letter : Byte_Value) return Frame_Format
   is (if Letter in Standard_Data | Standard_Remote
                   | Standard_Fd | Standard_Switched
       then Standard else Extended)
   with Global => null;

   function Is_Fd (Letter : Byte_Value) return Boolean
   is (Letter in Standard_Fd | Standard_Switched
                | Extended_Fd | Extended_Switched)
   with Global => null;

   function Kind_Of (Letter : Byte_Value) return Frame_Kind
   is (if Letter in Standard_Remote | Extended_Remote then Remote
       else Data)
   with Global => null;
   --  The kind of the frame, from the letter of its line.

   function Length_At
     (Line : Line_Bytes; Place : Positive) return Fd_Frames.Fd_Length
   is (Fd_Frames.Length_Of
         (Fd_Frames.Length_Code (Digit (Line (Place)))))
   with
     Global => null,
     Pre    => Place <= Line_Limit and then Is_Digit (Line (Place));
   --  The length with the code at Place.

   function Is_Frame_Line
     (Line : Line_Bytes; Count : Content_Length) return Boolean
   is (Count > 0
       and then Is_Letter (Line (1))
       and then Count >= Header (Format_Of (Line (1)))
       and then All_Digits (Line, Count)
       and then Number (Line, Format_Of (Line (1)))
         <= (if Format_Of (Line (1)) = Standard
             then 2**11 - 1 else 2**29 - 1)
       and then
         (Is_Fd (Line (1))
          or else Digit (Line (Header (Format_Of (Line (1))))) <= 8)
       and then Count =
         Header (Format_Of (Line (1)))
         + (if Kind_Of (Line (1)) = Remote
            then 0
            else 2 * Length_At (Line, Header (Format_Of (Line (1))))))
   with
     Ghost,
     Global => null;
   --  Are the first Count bytes of Line the line of a frame?

   function Letter_Of (F : Any_Frames.Any_Frame) return Byte_Value
   is (if F.Family = Any_Frames.Flexible
       then (case F.Fd.Rate is
               when Fd_Frames.Constant_Rate =>
                 (if F.Fd.Format = Standard
                  then Standard_Fd else Extended_Fd),
               when Fd_Frames.Switched_Rate =>
                 (if F.Fd.Format = Standard
                  then Standard_Switched else Extended_Switched))
       else (case F.Plain.Kind is
               when Data   =>
                 (if F.Plain.Format = Standard
                  then Standard_Data else Extended_Data),
               when Remote =>
                 (if F.Plain.Format = Standard
                  then Standard_Remote else Extended_Remote)))
   with Global => null;
   --  The letter of the line of F.

   function Length (F : Any_Frames.Any_Frame) return Fd_Frames.Fd_Length
   is (if F.Family = Any_Frames.Flexible then F.Fd.Length
       else F.Plain.Length)
   with Global => null;

   function Carried (F : Any_Frames.Any_Frame) return Fd_Frames.Fd_Length
   is (if F.Family = Any_Frames.Classic and then F.Plain.Kind = Remote
       then 0
       else Length (F))
   with Global => null;
   --  The number of bytes of data that F carries.

   function Stands_For
     (Line  : Line_Bytes;
      Count : Content_Length;
      F     : Any_Frames.Any_Frame) return Boolean
   is (Line (1) = Letter_Of (F)
       and then Count = Header (Any_Frames.Format (F)) + 2 * Carried (F)
       and then All_Digits (Line, Count)
       and then Number (Line, Any_Frames.Format (F))
         = Line_Number (Any_Frames.Id (F))
       and then Length_At (Line, Header (Any_Frames.Format (F)))
         = Length (F)
       and then Holds
         (Line, Header (Any_Frames.Format (F)) + 1, Carried (F),
          Any_Frames.Bytes (F)))
   with
     Ghost,
     Global => null;
   --  Is this the line of F?

   function Is_Same (A, B : Any_Frames.Any_Frame) return Boolean
   is (A.Family = B.Family
       and then Any_Frames.Id (A) = Any_Frames.Id (B)
       and then Any_Frames.Format (A) = Any_Frames.Format (B)
       and then Length (A) = Length (B)
       and then Carried (A) = Carried (B)
       and then
         (if A.Family = Any_Frames.Flexible
          then A.Fd.Rate = B.Fd.Rate
          else A.Plain.Kind = B.Plain.Kind)
       and then
         (for all I in 0 .. Carried (A) - 1 =>
            Any_Frames.Byte (A, I) = Any_Frames.Byte (B, I)))
   with
     Ghost,
     Global => null;
   --  Do A and B differ in nothing that a line carries?

   type Reading is record
      Found : Boolean := False;
      F     : Any_Frames.Any_Frame;
   end record;

   function Frame_In
     (Line : Line_Bytes; Count : Content_Length) return Reading
   with
     Global => null,
     Post   =>
       Frame_In'Result.Found = Is_Frame_Line (Line, Count)
       and then
         (if Frame_In'Result.Found
          then Stands_For (Line, Count, Frame_In'Result.F)
          else Frame_In'Result.F = Any_Frames.Null_Any_Frame);
   --  The frame of the line in the first Count bytes of Line, if Found.

   procedure Write
     (F     : Any_Frames.Any_Frame;
      Line  : out Line_Bytes;
      Count : out Content_Length)
   with
     Global => null,
     Post   => Stands_For (Line, Count, F);
   --  The line of F, as its first Count bytes.

   procedure Lemma_Read_Back
     (Line  : Line_Bytes;
      Count : Content_Length;
      F     : Any_Frames.Any_Frame)
   with
     Ghost,
     Global => null,
     Pre    => Stands_For (Line, Count, F),
     Post   =>
       Frame_In (Line, Count).Found
       and then Is_Same (Frame_In (Line, Count).F, F);
   --  The line of a frame is read as this frame.

end Ravenchart.Can.Slcan.Frame_Lines;
