--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The slcan line protocol: frames and commands as lines of ASCII that end in
--  a carriage return. CAN FD frames have lines too, d, D, b and B, as adapters
--  and python-can write them.
--
--  Guarantees   total: any bytes in any order are accepted; a bad or overlong
--               line is rejected as a whole, and the next one is read from its
--               start
--  Tasking      none of its own: one task owns each Parser
--  Timing       Feed and Format_Line are linear in the length of a line

with Interfaces;
with Ravenchart.Can.Any_Frames;

package Ravenchart.Can.Slcan
  with SPARK_Mode, Pure
is
   use type Any_Frames.Any_Frame;
   use type Any_Frames.Frame_Family;
   use type Interfaces.Unsigned_8;

   Carriage_Return : constant Interfaces.Unsigned_8 := 13;
   --  Ends every line.

   Bell : constant Interfaces.Unsigned_8 := 7;
   --  The answer of an adapter that refuses a line.

   Line_Limit : constant := 139;
   --  The longest line: D, 8 digits of identifier, 1 of the length code, 128
   --  of data, and the carriage return.

   subtype Line_Length is Natural range 0 .. Line_Limit;
   --  The number of bytes of a line.

   type Line_Bytes is array (Positive range 1 .. Line_Limit)
     of Interfaces.Unsigned_8;
   --  A line, followed by unused bytes.

   type Outcome is
     (Incomplete,
      Frame_Line,
      Open_Channel,
      Close_Channel,
      Version_Query,
      Serial_Query,
      Other_Command,
      Empty_Line,
      Rejected_Line);
   --  The line that the last byte completed. Other_Command needs no answer
   --  here: bit rates, filters, time stamps, an adapter's confirmation that it
   --  has sent a frame.

   type Parser is private
   with Default_Initial_Condition => Pending (Parser) = 0;
   --  The part of a line that was read so far.

   function Pending (P : Parser) return Line_Length
   with Global => null;
   --  The number of bytes of an unfinished line in P.

   procedure Feed
     (P      : in out Parser;
      Byte   : Interfaces.Unsigned_8;
      Result : out Outcome;
      F      : out Any_Frames.Any_Frame)
   with
     Global => null,
     Post   =>
       (Result = Incomplete) = (Byte /= Carriage_Return)
       and then (if Byte = Carriage_Return then Pending (P) = 0)
       and then (if Result /= Frame_Line then F = Any_Frames.Null_Any_Frame);
   --  Read one byte. F is the frame of a Frame_Line.

   procedure Format_Line
     (F    : Any_Frames.Any_Frame;
      Line : out Line_Bytes;
      Last : out Line_Length)
   with
     Global => null,
     Post   =>
       Last =
         (if Any_Frames.Format (F) = Standard then 6 else 11)
         + (if F.Family = Any_Frames.Flexible then 2 * F.Fd.Length
            elsif F.Plain.Kind = Data then 2 * F.Plain.Length
            else 0)
       and then Line (Last) = Carriage_Return;
   --  The line of F, with its carriage return. It does not carry the sender's
   --  error state.

private

   subtype Content_Length is Line_Length range 0 .. Line_Limit - 1;
   --  Bytes of a line before its carriage return.

   type Parser is record
      Line     : Line_Bytes := (others => 0);
      Count    : Content_Length := 0;
      Overlong : Boolean := False;
   end record;
   --  Overlong: bytes of this line were discarded.

   function Pending (P : Parser) return Line_Length
   is (P.Count);

end Ravenchart.Can.Slcan;
