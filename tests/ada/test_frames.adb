--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  CAN frames: payloads, bytes, and the conversion to slcan lines and back;
--  CAN FD frames and their lengths.

with Facts;
with Interfaces;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Slcan;

procedure Test_Frames is
   use Ravenchart.Can;
   use type Any_Frames.Any_Frame;
   use type Interfaces.Unsigned_8;
   use type Interfaces.Unsigned_64;
   use type Slcan.Outcome;

   Base : constant Frame_Format := Ravenchart.Can.Standard;
   --  The literal alone would be hidden by package Standard.

   Seed : Interfaces.Unsigned_64 := 1;

   function Random return Interfaces.Unsigned_64;
   --  The next number of a linear congruential generator.

   function Survives (F : Frame) return Boolean;
   --  Is F unchanged after the conversion to its line and back?

   procedure Check_Payloads;

   procedure Check_Lines;

   procedure Check_Samples;

   procedure Check_Fd_Frames;

   function Line_Of (F : Frame) return String;
   --  The line of F as text, without its carriage return.

   ------------
   -- Random --
   ------------

   function Random return Interfaces.Unsigned_64 is
   begin
      Seed := Seed * 6_364_136_223_846_793_005 + 1_442_695_040_888_963_407;
      return Interfaces.Rotate_Left (Seed, 31);
   end Random;

   --------------
   -- Survives --
   --------------

   function Survives (F : Frame) return Boolean is
      Parser : Slcan.Parser;
      Line   : Slcan.Line_Bytes;
      Last   : Slcan.Line_Length;
      Result : Slcan.Outcome := Slcan.Incomplete;
      Back   : Any_Frames.Any_Frame;
   begin
      Slcan.Format_Line (Any_Frames.To_Any (F), Line, Last);
      for I in 1 .. Last loop
         if Result /= Slcan.Incomplete then
            return False;
         end if;
         Slcan.Feed (Parser, Line (I), Result, Back);
      end loop;
      return Result = Slcan.Frame_Line
        and then Back = Any_Frames.To_Any (F);
   end Survives;

   -------------
   -- Line_Of --
   -------------

   function Line_Of (F : Frame) return String is
      Line : Slcan.Line_Bytes;
      Last : Slcan.Line_Length;
   begin
      Slcan.Format_Line (Any_Frames.To_Any (F), Line, Last);
      return Text : String (1 .. Last - 1) do
         for I in Text'Range loop
            Text (I) := Character'Val (Line (I));
         end loop;
      end return;
   end Line_Of;

   --------------------
   -- Check_Payloads --
   --------------------

   procedure Check_Payloads is
      Whole   : constant Interfaces.Unsigned_64 := 16#8877_6655_4433_2211#;
      F       : Frame;
      Masked  : Boolean := True;
      In_Line : Boolean := True;
   begin
      for Length in Data_Length loop
         F      := Data_Frame (16#123#, Base, Length, Whole);
         Masked := Masked
           and then Payload (F) = (Whole and Mask (Length));
         for I in Byte_Index loop
            In_Line := In_Line
              and then Byte (F, I) =
                (if I < Length then Interfaces.Unsigned_8 (16#11# * (I + 1))
                 else 0);
         end loop;
      end loop;
      Facts.Check ("a payload comes back within its length", Masked);
      Facts.Check ("byte 0 is the lowest of the payload", In_Line);
      Facts.Check
        ("a remote frame has no payload",
         Payload (Remote_Frame (5, Extended, 8)) = 0);
   end Check_Payloads;

   -----------------
   -- Check_Lines --
   -----------------

   procedure Check_Lines is
      Same   : Boolean := True;
      Format : Frame_Format;
      Id     : Identifier;
      Length : Data_Length;
   begin
      for I in 1 .. 20_000 loop
         Format := (if Random mod 2 = 0 then Base else Extended);
         Id     := Identifier
           (Random mod (if Format = Base then 2**11 else 2**29));
         Length := Data_Length (Random mod 9);
         Same   := Same
           and then Survives
             (if Random mod 4 = 0 then Remote_Frame (Id, Format, Length)
              else Data_Frame (Id, Format, Length, Random));
      end loop;
      Facts.Check ("20000 random frames survive slcan", Same);
      Same := Survives (Data_Frame (0, Base, 0, 0))
        and then Survives (Data_Frame (2**11 - 1, Base, 8, not 0))
        and then Survives (Data_Frame (2**29 - 1, Extended, 8, not 0))
        and then Survives (Remote_Frame (2**29 - 1, Extended, 8));
      Facts.Check ("the extreme frames survive slcan", Same);
   end Check_Lines;

   -------------------
   -- Check_Samples --
   -------------------

   procedure Check_Samples is
   begin
      Facts.Check
        ("a standard data frame is a t line",
         Line_Of (Data_Frame (16#1A#, Base, 2, 16#CDAB#))
         = "t01A2ABCD");
      Facts.Check
        ("an extended data frame is a T line",
         Line_Of (Data_Frame (16#1ABC_DEF0#, Extended, 1, 7))
         = "T1ABCDEF0107");
      Facts.Check
        ("a standard remote frame is an r line",
         Line_Of (Remote_Frame (16#7FF#, Base, 8)) = "r7FF8");
      Facts.Check
        ("an extended remote frame is an R line",
         Line_Of (Remote_Frame (1, Extended, 0)) = "R000000010");
   end Check_Samples;

   ---------------------
   -- Check_Fd_Frames --
   ---------------------

   procedure Check_Fd_Frames is
      use Ravenchart.Can.Fd_Frames;
      Full   : constant Fd_Bytes := (others => 16#A5#);
      F      : Fd_Frame;
      Cut    : Boolean := True;
      Given  : Fd_Words;
      Longer : Boolean := True;
      Whole  : Boolean := True;
   begin
      for Code in Length_Code loop
         F   := Fd_Data_Frame (5, Extended, Length_Of (Code), Full);
         Cut := Cut
           and then
             (for all I in Fd_Index =>
                Byte (F, I) = (if I < F.Length then 16#A5# else 0))
           and then F = Fd_Data_Frame (5, Extended, F.Length, F.Bytes);
         if Code > 0 then
            Longer := Longer
              and then Length_Of (Code) > Length_Of (Code - 1);
         end if;
      end loop;
      Facts.Check ("a CAN FD payload ends with its length", Cut);
      for Code in Length_Code loop
         for I in 1 .. 1_000 loop
            Given := (Random, Random, Random, Random,
                      Random, Random, Random, Random);
            F     := Fd_Data_Frame
              (5, Extended, Length_Of (Code), Given, Switched_Rate);
            Whole := Whole
              and then
                (for all I in Fd_Index =>
                   Byte (F, I)
                   = (if I < F.Length then Byte (Given, I) else 0))
              and then
                (if F.Length = 64 then Words (F) = Given
                 else F = Fd_Data_Frame
                        (5, Extended, F.Length, Words (F), Switched_Rate));
         end loop;
      end loop;
      Facts.Check ("words become bytes and words again", Whole);
      Facts.Check
        ("16 length codes stand for growing lengths up to 64",
         Longer and then Length_Of (15) = 64);
   end Check_Fd_Frames;

begin
   Check_Payloads;
   Check_Lines;
   Check_Samples;
   Check_Fd_Frames;
   Facts.Finish;
end Test_Frames;
