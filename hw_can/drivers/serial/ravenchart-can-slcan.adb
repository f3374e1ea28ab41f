--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Slcan.Frame_Lines;

package body Ravenchart.Can.Slcan
  with SPARK_Mode
is
   use Frame_Lines;

   function Is_Command
     (Line : Line_Bytes; Count : Content_Length; Letter : Character)
      return Boolean
   is (Count = 1 and then Line (1) = Code (Letter))
   with Global => null;
   --  Is the line this command, without anything behind it?

   function Settings_Are_Sound
     (Line : Line_Bytes; Count : Content_Length) return Boolean
   is (case Count is
         when 0      => False,
         when 1      => Line (1) in Code ('F') | Code ('P') | Code ('A')
                          | Code ('L') | Code ('E') | Code ('v'),
         when 2      => Line (1) in Code ('S') | Code ('Y') | Code ('Z')
                          | Code ('Q') | Code ('W') | Code ('X')
                        and then Line (2) in Code ('0') .. Code ('9'),
         when others => Line (1) in Code ('s') | Code ('M') | Code ('m')
                        and then (for all I in 2 .. Count =>
                                    Is_Digit (Line (I))))
   with Global => null;
   --  Is the line a command that needs no action here?

   function Needs_No_Action
     (Line : Line_Bytes; Count : Content_Length) return Boolean
   is (Settings_Are_Sound (Line, Count)
       or else (Count = 1 and then Line (1) in Code ('z') | Code ('Z')))
   with Global => null;
   --  Is the line such a command, or an adapter's confirmation that it has
   --  sent a frame?

   procedure Read_Line
     (Line   : Line_Bytes;
      Count  : Content_Length;
      Result : out Outcome;
      F      : out Any_Frames.Any_Frame)
   with
     Global => null,
     Post   =>
       Result /= Incomplete
       and then (Result = Empty_Line) = (Count = 0)
       and then (Result = Frame_Line) = Is_Frame_Line (Line, Count)
       and then
         (Result = Open_Channel) = Is_Command (Line, Count, 'O')
       and then
         (Result = Close_Channel) = Is_Command (Line, Count, 'C')
       and then
         (Result = Version_Query) = Is_Command (Line, Count, 'V')
       and then
         (Result = Serial_Query) = Is_Command (Line, Count, 'N')
       and then
         (Result = Other_Command) = Needs_No_Action (Line, Count)
       and then
         (if Result = Frame_Line
          then Stands_For (Line, Count, F)
          else F = Any_Frames.Null_Any_Frame);
   --  The meaning of the first Count bytes of Line. Every other line is
   --  rejected.

   ---------------
   -- Read_Line --
   ---------------

   procedure Read_Line
     (Line   : Line_Bytes;
      Count  : Content_Length;
      Result : out Outcome;
      F      : out Any_Frames.Any_Frame)
   is
      Read : constant Reading := Frame_In (Line, Count);
   begin
      F := Read.F;
      if Count = 0 then
         Result := Empty_Line;
      elsif Read.Found then
         Result := Frame_Line;
      elsif Is_Command (Line, Count, 'O') then
         Result := Open_Channel;
      elsif Is_Command (Line, Count, 'C') then
         Result := Close_Channel;
      elsif Is_Command (Line, Count, 'V') then
         Result := Version_Query;
      elsif Is_Command (Line, Count, 'N') then
         Result := Serial_Query;
      elsif Needs_No_Action (Line, Count) then
         Result := Other_Command;
      else
         Result := Rejected_Line;
      end if;
   end Read_Line;

   ----------
   -- Feed --
   ----------

   procedure Feed
     (P      : in out Parser;
      Byte   : Interfaces.Unsigned_8;
      Result : out Outcome;
      F      : out Any_Frames.Any_Frame) is
   begin
      F      := Any_Frames.Null_Any_Frame;
      Result := Incomplete;
      if Byte = Carriage_Return then
         if P.Overlong then
            Result := Rejected_Line;
         else
            Read_Line (P.Line, P.Count, Result, F);
         end if;
         P.Count    := 0;
         P.Overlong := False;
      elsif P.Count < Content_Length'Last then
         P.Count          := P.Count + 1;
         P.Line (P.Count) := Byte;
      else
         P.Overlong := True;
      end if;
   end Feed;

   -----------------
   -- Format_Line --
   -----------------

   procedure Format_Line
     (F    : Any_Frames.Any_Frame;
      Line : out Line_Bytes;
      Last : out Line_Length) is
   begin
      Write (F, Line, Last);
      Last        := Last + 1;
      Line (Last) := Carriage_Return;
   end Format_Line;

end Ravenchart.Can.Slcan;
