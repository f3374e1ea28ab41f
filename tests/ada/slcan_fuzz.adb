--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Random byte strings through the slcan parser. The two arguments are their
--  number, and the number of first lines to print. A quarter are any bytes, a
--  quarter bytes that lines are made of, a quarter lines of frames, and a
--  quarter such lines with a byte changed. The program stops with "not ok"
--  where a line is read as a frame with another line, or the line of a frame
--  as anything else. It prints HEX/OUTCOME[/FORMAT/KIND/ID/LENGTH/PAYLOAD],
--  then the number of frames; KIND of CAN FD frames is DATA_FD, their PAYLOAD
--  the sum of their words.

with Ada.Command_Line;
with Ada.Text_IO;
with Facts;
with Interfaces;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Slcan;

procedure Slcan_Fuzz is
   use Ravenchart.Can;
   use type Any_Frames.Any_Frame;
   use type Any_Frames.Frame_Family;
   use type Interfaces.Unsigned_8;
   use type Interfaces.Unsigned_64;
   use type Slcan.Outcome;

   subtype Byte_Value is Interfaces.Unsigned_8;

   Longest : constant := Slcan.Line_Limit + 6;
   --  The longest string: some are too long for a line.

   Short : constant := 32;
   --  The length of half of them at most, as of commands and classic frames.

   type Byte_String is array (Positive range 1 .. Longest) of Byte_Value;

   type Drawing is (Any_Bytes, Bytes_Of_Lines, Changed_Line, Whole_Line);

   Alphabet : constant String := "tTrRdDbB0123456789ABCDEFabcdefOCSVNsMm";

   Strings : constant Natural :=
     Natural'Value (Ada.Command_Line.Argument (1));
   Shown   : constant Natural :=
     Natural'Value (Ada.Command_Line.Argument (2));

   Parser : Slcan.Parser;
   Text   : Byte_String := (others => 0);
   Length : Natural := 0;
   Sent   : Any_Frames.Any_Frame;
   --  The frame of the line in Text, before a byte was changed.
   Line   : Byte_String := (others => 0);
   Count  : Natural := 0;
   --  The bytes fed since the last carriage return.
   Lines  : Natural := 0;
   Frames : Natural := 0;
   Seed   : Interfaces.Unsigned_64 := 16#9E37_79B9_7F4A_7C15#;

   function Random return Interfaces.Unsigned_64;
   --  Marsaglia's xorshift, of period 2**64 - 1, times a constant (Vigna's
   --  xorshift64*): without it the low bits would follow from those before.

   function Below (Limit : Positive) return Natural
   is (Natural
         (Interfaces.Shift_Right (Random, 32)
          mod Interfaces.Unsigned_64 (Limit)));

   function Any_Byte return Byte_Value
   is (Byte_Value (Below (256)));

   function Byte_Of_Lines return Byte_Value
   is (Character'Pos (Alphabet (1 + Below (Alphabet'Length))));

   function Random_Frame return Any_Frames.Any_Frame;

   procedure Draw (How : Drawing);

   procedure Expect (Fact : String; Holds : Boolean);
   --  Stop where the fact does not hold.

   procedure Judge (Result : Slcan.Outcome; F : Any_Frames.Any_Frame);
   --  Line has ended.

   function Content (F : Any_Frames.Any_Frame) return String;
   --  Kind, identifier, length and payload.

   function Hex return String;
   --  The bytes of Line.

   ------------
   -- Random --
   ------------

   function Random return Interfaces.Unsigned_64 is
   begin
      Seed := Seed xor Interfaces.Shift_Left (Seed, 13);
      Seed := Seed xor Interfaces.Shift_Right (Seed, 7);
      Seed := Seed xor Interfaces.Shift_Left (Seed, 17);
      return Seed * 16#2545_F491_4F6C_DD1D#;
   end Random;

   ------------------
   -- Random_Frame --
   ------------------

   function Random_Frame return Any_Frames.Any_Frame is
      Format : constant Frame_Format :=
        Frame_Format'Val (Below (2));
      Id     : constant Identifier :=
        Identifier
          (Below (if Format = Extended then 2**29 else 2**11));
   begin
      case Below (4) is
         when 0 =>
            return Any_Frames.To_Any (Remote_Frame (Id, Format, Below (9)));
         when 1 =>
            return Any_Frames.To_Any
              (Data_Frame (Id, Format, Below (9), Random));
         when others =>
            return Any_Frames.To_Any
              (Fd_Frames.Fd_Data_Frame
                 (Id, Format,
                  Fd_Frames.Length_Of (Fd_Frames.Length_Code (Below (16))),
                  Words => (Random, Random, Random, Random,
                            Random, Random, Random, Random),
                  Rate  => Fd_Frames.Bit_Rate_Use'Val (Below (2))));
      end case;
   end Random_Frame;

   ----------
   -- Draw --
   ----------

   procedure Draw (How : Drawing) is
      Whole : Slcan.Line_Bytes;
      Last  : Slcan.Line_Length;
   begin
      Length := Below ((if Below (2) = 0 then Short else Longest) + 1);
      case How is
         when Any_Bytes =>
            for I in 1 .. Length loop
               Text (I) := Any_Byte;
            end loop;
         when Bytes_Of_Lines =>
            for I in 1 .. Length loop
               Text (I) := Byte_Of_Lines;
            end loop;
         when Changed_Line | Whole_Line =>
            Sent := Random_Frame;
            Slcan.Format_Line (Sent, Whole, Last);
            Length := Last - 1;
            for I in 1 .. Length loop
               Text (I) := Whole (I);
            end loop;
            if How = Changed_Line then
               Text (1 + Below (Length)) :=
                 (if Below (2) = 0 then Any_Byte else Byte_Of_Lines);
               Length := Length - Below (2);
            end if;
      end case;
   end Draw;

   ------------
   -- Expect --
   ------------

   procedure Expect (Fact : String; Holds : Boolean) is
   begin
      if not Holds then
         Facts.Check (Fact & ": " & Hex, False);
         Facts.Finish;
      end if;
   end Expect;

   ---------
   -- Hex --
   ---------

   function Hex return String is
      Of_Digit : constant String := "0123456789abcdef";
      Written  : String (1 .. 2 * Count);
   begin
      for I in 1 .. Count loop
         Written (2 * I - 1) := Of_Digit (1 + Natural (Line (I) / 16));
         Written (2 * I)     := Of_Digit (1 + Natural (Line (I) mod 16));
      end loop;
      return Written;
   end Hex;

   -------------
   -- Content --
   -------------

   function Content (F : Any_Frames.Any_Frame) return String is
      Sum : Interfaces.Unsigned_64 := 0;
   begin
      for Word of Any_Frames.Words (F) loop
         Sum := Sum + Word;
      end loop;
      return
        (if F.Family = Any_Frames.Flexible
         then "DATA_FD/" & F.Fd.Id'Image & "/" & F.Fd.Length'Image & "/"
              & Sum'Image
         else F.Plain.Kind'Image & "/" & F.Plain.Id'Image & "/"
              & F.Plain.Length'Image & "/" & Payload (F.Plain)'Image);
   end Content;

   -----------
   -- Judge --
   -----------

   procedure Judge (Result : Slcan.Outcome; F : Any_Frames.Any_Frame) is
      Again : Slcan.Line_Bytes;
      Last  : Slcan.Line_Length;

      function Capital (B : Byte_Value) return Byte_Value
      is (if B in Character'Pos ('a') .. Character'Pos ('f') then B - 32
          else B);
   begin
      Lines := Lines + 1;
      if Result = Slcan.Frame_Line then
         Frames := Frames + 1;
         Expect
           ("a frame is one",
            F.Plain.Length'Valid and then F.Plain.Id'Valid
            and then F.Fd.Length'Valid and then F.Fd.Id'Valid
            and then Fits (Any_Frames.Id (F), Any_Frames.Format (F)));
         Slcan.Format_Line (F, Again, Last);
         Expect
           ("a frame is written as it was read",
            Last = Count + 1
            and then Again (1) = Line (1)
            and then (for all I in 2 .. Count =>
                        Again (I) = Capital (Line (I))));
      else
         Expect ("no frame, no data", F = Any_Frames.Null_Any_Frame);
      end if;
      if Lines <= Shown then
         Ada.Text_IO.Put_Line
           (Hex & "/" & Result'Image
            & (if Result /= Slcan.Frame_Line then ""
               else "/" & Any_Frames.Format (F)'Image & "/" & Content (F)));
      end if;
   end Judge;

   How    : Drawing;
   Byte   : Byte_Value;
   Result : Slcan.Outcome;
   F      : Any_Frames.Any_Frame;
begin
   for Unused in 1 .. Strings loop
      How := Drawing'Val (Below (4));
      Draw (How);
      for I in 1 .. Length + 1 loop
         Byte := (if I > Length then Slcan.Carriage_Return else Text (I));
         Slcan.Feed (Parser, Byte, Result, F);
         if Byte = Slcan.Carriage_Return then
            Judge (Result, F);
            Count := 0;
         else
            Count        := Count + 1;
            Line (Count) := Byte;
            Expect
              ("a line ends with its carriage return",
               Result = Slcan.Incomplete);
         end if;
      end loop;
      if How = Whole_Line then
         Expect
           ("the line of a frame is read",
            Result = Slcan.Frame_Line and then F = Sent);
      end if;
   end loop;
   Ada.Text_IO.Put_Line (Natural'Image (Frames));
   Facts.Finish;
end Slcan_Fuzz;
