--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Frames as bits on the bus: check sequences, stuff bits, and lengths.
--
--  The check values of the CRCs are those of the CRC catalogue of G. Cook
--  (CRC-15/CAN, CRC-17/CAN-FD, CRC-21/CAN-FD). Lengths and check fields of
--  whole frames are the results of the frame generators by P. Molinaro
--  (repository pierremolinaro/codes-can, state of 14 March 2025).

with Ada.Text_IO;
with Facts;
with Interfaces;
with Ravenchart.Can;
with Ravenchart.Can.Crcs;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Levels;
with Ravenchart.Can.Wire;

procedure Test_Wire is
   use Ravenchart.Can;
   use Ravenchart.Can.Fd_Frames;
   use type Interfaces.Unsigned_8;
   use type Interfaces.Unsigned_32;
   use type Interfaces.Unsigned_64;
   use type Levels.Level;

   Base : constant Frame_Format := Ravenchart.Can.Standard;
   --  The literal alone would be hidden by package Standard.

   Seed : Interfaces.Unsigned_64 := 1;

   function Random return Interfaces.Unsigned_64;
   --  The next number of a linear congruential generator.

   function Check_Value (Kind : Crcs.Crc_Kind) return Crcs.Register;
   --  The register, from 0, after the nine bytes "123456789".

   function Row
     (Factor, First : Interfaces.Unsigned_8) return Fd_Bytes;
   --  First, First + Factor, and so on.

   function Word (Bytes : Fd_Bytes) return Interfaces.Unsigned_64;
   --  The first eight of them, as a classic frame has them.

   function Text
     (Picture : Wire.Image; First, Last : Wire.Bit_Count) return String;
   --  These bits, as 0 and 1.

   function Check_Field (Picture : Wire.Image) return String;
   --  Stuff count, CRC and stuff bits.

   procedure Check_Crcs;

   procedure Check_Classic;

   procedure Check_Fd;

   function Stuffing (Picture : Wire.Image) return Fd_Bytes;
   --  The data that cause the most stuff bits after this head.

   procedure Print_Lengths;
   --  Print a line for each length, for the test that knows the analysis.

   ------------
   -- Random --
   ------------

   function Random return Interfaces.Unsigned_64 is
   begin
      Seed := Seed * 6_364_136_223_846_793_005 + 1_442_695_040_888_963_407;
      return Interfaces.Rotate_Left (Seed, 31);
   end Random;

   -----------------
   -- Check_Value --
   -----------------

   function Check_Value (Kind : Crcs.Crc_Kind) return Crcs.Register is
      Result : Crcs.Register := 0;
      Code   : Interfaces.Unsigned_32;
   begin
      for C in Character range '1' .. '9' loop
         Code := Character'Pos (C);
         for I in reverse 0 .. 7 loop
            Result := Crcs.Next
              (Kind,
               Result,
               Levels.To_Level
                 ((Interfaces.Shift_Right (Code, I) and 1) = 1));
         end loop;
      end loop;
      return Result;
   end Check_Value;

   ---------
   -- Row --
   ---------

   function Row
     (Factor, First : Interfaces.Unsigned_8) return Fd_Bytes is
   begin
      return Bytes : Fd_Bytes do
         for I in Fd_Index loop
            Bytes (I) := Factor * Interfaces.Unsigned_8 (I) + First;
         end loop;
      end return;
   end Row;

   ----------
   -- Word --
   ----------

   function Word (Bytes : Fd_Bytes) return Interfaces.Unsigned_64 is
      Result : Interfaces.Unsigned_64 := 0;
   begin
      for I in reverse Byte_Index loop
         Result := 256 * Result + Interfaces.Unsigned_64 (Bytes (I));
      end loop;
      return Result;
   end Word;

   ----------
   -- Text --
   ----------

   function Text
     (Picture : Wire.Image; First, Last : Wire.Bit_Count) return String is
   begin
      return Result : String (1 .. Last - First + 1) do
         for I in Result'Range loop
            Result (I) :=
              (if Picture.Bits (First + I - 1) = Levels.Dominant then '0'
               else '1');
         end loop;
      end return;
   end Text;

   -----------------
   -- Check_Field --
   -----------------

   function Check_Field (Picture : Wire.Image) return String
   is (Text
         (Picture,
          Picture.Ends (Wire.Data_Field) + 1,
          Picture.Ends (Wire.Check_Field)));

   ----------------
   -- Check_Crcs --
   ----------------

   procedure Check_Crcs is
   begin
      Facts.Check ("CRC-15 has its check value",
                   Check_Value (Crcs.Crc_15) = 16#059E#);
      Facts.Check ("CRC-17 has its check value",
                   Check_Value (Crcs.Crc_17) = 16#0_4F03#);
      Facts.Check ("CRC-21 has its check value",
                   Check_Value (Crcs.Crc_21) = 16#0E_D841#);
   end Check_Crcs;

   -------------------
   -- Check_Classic --
   -------------------

   procedure Check_Classic is

      procedure Check
        (Name            : String;
         F               : Frame;
         Length, Stuffed : Natural;
         Ending          : String);
      --  The frame has this length and these last bits.

      procedure Check
        (Name            : String;
         F               : Frame;
         Length, Stuffed : Natural;
         Ending          : String)
      is
         Picture : constant Wire.Image := Wire.To_Wire (F);
      begin
         Facts.Check
           ("classic frame " & Name & " is as another generator has it",
            Wire.Length (Picture) = Length
            and then Picture.Stuffed = Stuffed
            and then
              Text (Picture, Length - Ending'Length + 1, Length) = Ending);
      end Check;

   begin
      Check
        ("78",
         Data_Frame (16#78#, Base, 8, 16#E1E1_E1E1_E1E1_E101#),
         130, 19,
         "110101000101000111111111111111");
      Check
        ("14",
         Data_Frame (16#14#, Base, 1, Word (Row (0, 1))),
         58, 3,
         "011110111010100111111111111111");
      Check
        ("7FF",
         Data_Frame (16#7FF#, Base, 8, Word (Row (0, 255))),
         126, 15,
         "110001100100010011111111111111");
      Check
        ("0",
         Data_Frame (16#0#, Base, 8, Word (Row (0, 0))),
         127, 16,
         "000010100010110111111111111111");
      Check
        ("555 remote",
         Remote_Frame (16#555#, Base, 4),
         47, 0,
         "001001100010001101111111111111");
      Check
        ("1ABCDEF0",
         Data_Frame (16#1ABCDEF0#, Extended, 8, Word (Row (37, 11))),
         136, 5,
         "100111001010110011111111111111");
      Check
        ("0 remote",
         Remote_Frame (16#0#, Extended, 0),
         73, 6,
         "100110101110101011111111111111");
      Check
        ("1FFFFFFF",
         Data_Frame (16#1FFFFFFF#, Extended, 8, Word (Row (0, 255))),
         149, 18,
         "110011011011010011111111111111");
      Check
        ("47F",
         Data_Frame (16#47F#, Base, 1, Word (Row (0, 31))),
         58, 3,
         "101100110110101111111111111111");
   end Check_Classic;

   --------------
   -- Check_Fd --
   --------------

   procedure Check_Fd is

      procedure Check
        (Name            : String;
         F               : Fd_Frame;
         Length, Stuffed : Natural;
         Field           : String);
      --  The frame has this length and this check field.

      procedure Check
        (Name            : String;
         F               : Fd_Frame;
         Length, Stuffed : Natural;
         Field           : String)
      is
         Picture : constant Wire.Image := Wire.To_Wire (F);
      begin
         Facts.Check
           ("CAN FD frame " & Name & " is as another generator has it",
            Wire.Length (Picture) = Length
            and then Picture.Stuffed = Stuffed
            and then Check_Field (Picture) = Field);
      end Check;

   begin
      Check
        ("123 of 0",
         Fd_Data_Frame
           (16#123#, Base, 0, Row (37, 11),
            Switched_Rate, Active_Sender),
         62, 0,
         "100001111100110110001100100");
      Check
        ("14 of 1",
         Fd_Data_Frame
           (16#14#, Base, 1, Row (0, 1),
            Constant_Rate, Active_Sender),
         73, 3,
         "001010010101101011101011011");
      Check
        ("7FF of 8",
         Fd_Data_Frame
           (16#7FF#, Base, 8, Row (0, 255),
            Switched_Rate, Passive_Sender),
         140, 14,
         "010101011101110101101111100");
      Check
        ("0 of 16",
         Fd_Data_Frame
           (16#0#, Base, 16, Row (0, 0),
            Switched_Rate, Active_Sender),
         217, 27,
         "101010101101111001101001101");
      Check
        ("555 of 20",
         Fd_Data_Frame
           (16#555#, Base, 20, Row (37, 11),
            Switched_Rate, Active_Sender),
         233, 6,
         "11010101010010101100100110001100");
      Check
        ("1ABCDEF0 of 8",
         Fd_Data_Frame
           (16#1ABCDEF0#, Extended, 8, Row (37, 11),
            Switched_Rate, Active_Sender),
         150, 5,
         "111110110010011001001100101");
      Check
        ("1FFFFFFF of 64",
         Fd_Data_Frame
           (16#1FFFFFFF#, Extended, 64, Row (0, 255),
            Switched_Rate, Active_Sender),
         707, 109,
         "01111010101100101111011101010010");
      Check
        ("0 of 64",
         Fd_Data_Frame
           (16#0#, Extended, 64, Row (0, 0),
            Switched_Rate, Active_Sender),
         705, 107,
         "10101001110011101011001010100101");
      Check
        ("12345678 of 64",
         Fd_Data_Frame
           (16#12345678#, Extended, 64, Row (37, 11),
            Constant_Rate, Passive_Sender),
         617, 19,
         "10101001010101010001001101001101");
      Check
        ("7E of 32",
         Fd_Data_Frame
           (16#7E#, Extended, 32, Row (0, 225),
            Switched_Rate, Active_Sender),
         347, 5,
         "01111001101010010000111110001010");
   end Check_Fd;

   --------------
   -- Stuffing --
   --------------

   function Stuffing (Picture : Wire.Image) return Fd_Bytes is
      Last  : Levels.Level :=
        Picture.Bits (Picture.Ends (Wire.Length_Bits));
      Run   : Natural := 1;
      Bytes : Fd_Bytes := (others => 0);
   begin
      while Picture.Bits (Picture.Ends (Wire.Length_Bits) - Run) = Last loop
         Run := Run + 1;
      end loop;
      for Byte of Bytes loop
         for I in 1 .. 8 loop
            if Run = 5 then
               Last := Levels.Inverse (Last);
               Run  := 1;
            end if;
            Byte := 2 * Byte + Levels.Level'Pos (Last);
            Run  := Run + 1;
         end loop;
      end loop;
      return Bytes;
   end Stuffing;

   -------------------
   -- Print_Lengths --
   -------------------

   procedure Print_Lengths is
      Longest : Wire.Phases;
      Plain   : Wire.Bit_Count;

      procedure Note (Picture : Wire.Image; Rate : Bit_Rate_Use);
      --  Keep the longest phases.

      procedure Print (Kind : String; Format : Frame_Format; Size : Natural);
      --  Print one line: frame, length, bits without stuff bits, longest
      --  phases.

      function Some_Id (Format : Frame_Format; I : Natural)
        return Identifier;
      --  Every standard identifier, or as many extended ones.

      procedure Note (Picture : Wire.Image; Rate : Bit_Rate_Use) is
         Found : constant Wire.Phases := Wire.Phases_Of (Picture, Rate);
      begin
         Plain := Wire.Length (Picture) - Picture.Stuffed;
         if Found.Nominal + Found.Data > Longest.Nominal + Longest.Data then
            Longest := Found;
         end if;
      end Note;

      procedure Print (Kind : String; Format : Frame_Format; Size : Natural)
      is
      begin
         Ada.Text_IO.Put_Line
           ("bits " & Kind & (if Format = Base then " standard"
                              else " extended")
            & Natural'Image (Size)
            & Natural'Image (Plain)
            & Natural'Image (Longest.Nominal)
            & Natural'Image (Longest.Data));
         Longest := (others => 0);
      end Print;

      function Some_Id (Format : Frame_Format; I : Natural)
        return Identifier
      is (if Format = Base then Identifier (I)
          elsif I < 1024 then 2**18 * Identifier (2 * I) + 2**17 - 1
          else Identifier (Random mod 2**29));

      Bytes : Fd_Bytes;
      F     : Fd_Frame;
      Id    : Identifier;
   begin
      for Format in Frame_Format loop
         for Size in Data_Length loop
            for I in 0 .. 2047 loop
               Id    := Some_Id (Format, I);
               Bytes := Stuffing
                 (Wire.To_Wire (Data_Frame (Id, Format, Size, 0)));
               Note
                 (Wire.To_Wire (Data_Frame (Id, Format, Size, Word (Bytes))),
                  Constant_Rate);
            end loop;
            Print ("classic", Format, Size);
         end loop;
         for Code in Length_Code loop
            for I in 0 .. (if Format = Base then 2047 else 255) loop
               for Sender in Sender_State loop
                  F     := Fd_Data_Frame
                    (Some_Id (Format, I), Format, Length_Of (Code),
                     (others => 0), Switched_Rate, Sender);
                  Bytes := Stuffing (Wire.To_Wire (F));
                  Note
                    (Wire.To_Wire
                       (Fd_Data_Frame
                          (F.Id, Format, F.Length, Bytes,
                           Switched_Rate, Sender)),
                     Switched_Rate);
               end loop;
            end loop;
            Print ("fd", Format, F.Length);
         end loop;
      end loop;
   end Print_Lengths;

begin
   Check_Crcs;
   Check_Classic;
   Check_Fd;
   Print_Lengths;
   Facts.Finish;
end Test_Wire;
