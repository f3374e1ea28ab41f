--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The slcan parser: valid lines and garbage.

with Facts;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Slcan;

procedure Test_Slcan is
   use Ravenchart.Can;
   use Ravenchart.Can.Any_Frames;
   use Ravenchart.Can.Fd_Frames;
   use type Slcan.Outcome;

   Base : constant Frame_Format := Ravenchart.Can.Standard;
   --  The literal alone would be hidden by package Standard.

   Parser : Slcan.Parser;

   procedure Feed
     (Text : String; Result : out Slcan.Outcome; F : out Any_Frame);
   --  Feed a line and its carriage return.

   function Says (Text : String; Expected : Slcan.Outcome) return Boolean;
   --  Does the parser read the line as Expected?

   procedure Check_Frames;

   procedure Check_Commands;

   procedure Check_Garbage;

   ----------
   -- Feed --
   ----------

   procedure Feed
     (Text : String; Result : out Slcan.Outcome; F : out Any_Frame) is
   begin
      for C of Text loop
         Slcan.Feed (Parser, Character'Pos (C), Result, F);
         if Result /= Slcan.Incomplete then
            return;
         end if;
      end loop;
      Slcan.Feed (Parser, Slcan.Carriage_Return, Result, F);
   end Feed;

   ----------
   -- Says --
   ----------

   function Says (Text : String; Expected : Slcan.Outcome) return Boolean is
      Result : Slcan.Outcome;
      F      : Any_Frame;
   begin
      Feed (Text, Result, F);
      return Result = Expected;
   end Says;

   ------------------
   -- Check_Frames --
   ------------------

   procedure Check_Frames is
      Result : Slcan.Outcome;
      F      : Any_Frame;
   begin
      Feed ("t1232AbcD", Result, F);
      Facts.Check
        ("a t line is a standard data frame, digits of either case",
         Result = Slcan.Frame_Line
         and then F = To_Any (Data_Frame (16#123#, Base, 2, 16#CDAB#)));
      Feed ("T0000000181122334455667788", Result, F);
      Facts.Check
        ("a T line is an extended data frame",
         Result = Slcan.Frame_Line
         and then F =
           To_Any
             (Data_Frame (1, Extended, 8, 16#8877_6655_4433_2211#)));
      Feed ("r7FF4", Result, F);
      Facts.Check
        ("an r line is a standard remote frame",
         Result = Slcan.Frame_Line
         and then F = To_Any (Remote_Frame (16#7FF#, Base, 4)));
      Feed ("R1FFFFFFF0", Result, F);
      Facts.Check
        ("an R line is an extended remote frame",
         Result = Slcan.Frame_Line
         and then F = To_Any (Remote_Frame (2**29 - 1, Extended, 0)));
      Feed ("d12390102030405060708090A0B0C", Result, F);
      Facts.Check
        ("a d line is a CAN FD frame of one bit rate, by its length code",
         Result = Slcan.Frame_Line
         and then F =
           To_Any
             (Fd_Data_Frame
                (16#123#, Base, 12,
                 Words => (0 => 16#0807_0605_0403_0201#,
                           1 => 16#0C0B_0A09#, others => 0),
                 Rate  => Constant_Rate)));
      Feed ("B000000010", Result, F);
      Facts.Check
        ("a B line is an extended CAN FD frame that switches",
         Result = Slcan.Frame_Line
         and then F =
           To_Any
             (Fd_Data_Frame
                (1, Extended, 0, Words => (others => 0),
                 Rate => Switched_Rate)));
      Feed ("D1FFFFFFFF" & (1 .. 128 => '5'), Result, F);
      Facts.Check
        ("the longest line is a frame",
         Result = Slcan.Frame_Line
         and then F =
           To_Any
             (Fd_Data_Frame
                (2**29 - 1, Extended, 64,
                 Words => (others => 16#5555_5555_5555_5555#),
                 Rate  => Constant_Rate)));
   end Check_Frames;

   --------------------
   -- Check_Commands --
   --------------------

   procedure Check_Commands is
   begin
      Facts.Check
        ("the opening of python-can is understood",
         Says ("C", Slcan.Close_Channel)
         and then Says ("S6", Slcan.Other_Command)
         and then Says ("", Slcan.Empty_Line)
         and then Says ("O", Slcan.Open_Channel)
         and then Says ("O", Slcan.Open_Channel));
      Facts.Check
        ("the queries are understood",
         Says ("V", Slcan.Version_Query)
         and then Says ("N", Slcan.Serial_Query));
      Facts.Check
        ("settings are taken and need no answer",
         Says ("S0", Slcan.Other_Command)
         and then Says ("S8", Slcan.Other_Command)
         and then Says ("s031C", Slcan.Other_Command)
         and then Says ("M00000000", Slcan.Other_Command)
         and then Says ("mFFFFFFFF", Slcan.Other_Command)
         and then Says ("Z1", Slcan.Other_Command)
         and then Says ("F", Slcan.Other_Command));
   end Check_Commands;

   -------------------
   -- Check_Garbage --
   -------------------

   procedure Check_Garbage is
      type Text_Access is access constant String;

      function "+" (Text : String) return Text_Access
      is (new String'(Text));

      Bad   : constant array (Positive range <>) of Text_Access :=
        (+"t", +"t12", +"t123", +"t1239", +"t12321", +"t1232112233",
         +"t8000", +"tXYZ0", +"t1231G0", +"T123", +"T2000000000",
         +"T00000001", +"r12", +"r12341", +"R0000000", +"d12",
         +"b1232AABBCC", +"D1230",
         +"d12391122334455", +"O1",
         +"C0", +"VV", +"S", +"SX", +"?", +"hello", +"t12300112233");
      Right : Boolean := True;
   begin
      for Text of Bad loop
         if not Says (Text.all, Slcan.Rejected_Line) then
            Facts.Check ("bad line " & Text.all, False);
            Right := False;
         end if;
         Right := Right and then Says ("r0010", Slcan.Frame_Line);
      end loop;
      Facts.Check ("bad lines are rejected, the next one is read", Right);
      Right := Says ((1 .. 138 => 'x'), Slcan.Rejected_Line)
        and then Says ((1 .. 139 => 'x'), Slcan.Rejected_Line)
        and then Says ((1 .. 5_000 => 't'), Slcan.Rejected_Line)
        and then Says
          ("T00000001811223344556677889", Slcan.Rejected_Line)
        and then Says ("r0010", Slcan.Frame_Line);
      Facts.Check ("overlong lines are rejected as a whole", Right);
      Facts.Check
        ("a parser that has read a line waits for the next",
         Slcan.Pending (Parser) = 0);
   end Check_Garbage;

begin
   Check_Frames;
   Check_Commands;
   Check_Garbage;
   Facts.Finish;
end Test_Slcan;
