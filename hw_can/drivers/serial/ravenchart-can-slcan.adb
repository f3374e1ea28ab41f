with Ravenchart.Can.Fd_Frames;

package body Ravenchart.Can.Slcan
  with SPARK_Mode
is
   use type Fd_Frames.Bit_Rate_Use;

   subtype Byte_Value is Interfaces.Unsigned_8;

   function Code (C : Character) return Byte_Value
   is (Character'Pos (C))
   with Global => null;
   --  The ASCII code of C.

   Capital : constant Byte_Value := Character'Pos ('a') - Character'Pos ('A');
   --  By how much the code of a capital is below that of the small letter.

   subtype Digit_Value is Byte_Value range 0 .. 15;
   --  What one digit is worth.

   function Is_Digit (B : Byte_Value) return Boolean
   is (B in Code ('0') .. Code ('9')
         | Code ('A') .. Code ('F')
         | Code ('a') .. Code ('f'))
   with Global => null;
   --  Is B a hexadecimal digit?

   function Digit (B : Byte_Value) return Digit_Value
   is (if B <= Code ('9') then B - Code ('0')
       elsif B <= Code ('F') then B - Code ('A') + 10
       else B - Code ('a') + 10)
   with
     Global => null,
     Pre    => Is_Digit (B);
   --  What the digit B is worth.

   function Image (Value : Digit_Value) return Byte_Value
   is (if Value < 10 then Code ('0') + Value
       else Code ('A') + (Value - 10))
   with Global => null;
   --  The digit that is worth Value.

   function Id_Digits (Format : Frame_Format) return Positive
   is (if Format = Standard then 3 else 8)
   with Global => null;
   --  Digits of the identifier in a line.

   procedure Read_Frame
     (Line  : Line_Bytes;
      Count : Content_Length;
      Found : out Boolean;
      F     : out Any_Frames.Any_Frame)
   with
     Global => null,
     Pre    => Count >= 1,
     Post   => (if not Found then F = Any_Frames.Null_Any_Frame);
   --  The frame that the first Count bytes of Line stand for, if Found.

   procedure Read_Line
     (Line   : Line_Bytes;
      Count  : Content_Length;
      Result : out Outcome;
      F      : out Any_Frames.Any_Frame)
   with
     Global => null,
     Post   =>
       Result /= Incomplete
       and then
         (if Result /= Frame_Line then F = Any_Frames.Null_Any_Frame);
   --  What the first Count bytes of Line say.

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
   --  Is the line one of the commands that need no action here?

   ----------------
   -- Read_Frame --
   ----------------

   procedure Read_Frame
     (Line  : Line_Bytes;
      Count : Content_Length;
      Found : out Boolean;
      F     : out Any_Frames.Any_Frame)
   is
      Format  : constant Frame_Format :=
        (if Line (1) in Code ('t') | Code ('r') | Code ('d') | Code ('b')
         then Standard else Extended);
      Is_Fd   : constant Boolean :=
        Line (1) in Code ('d') | Code ('D') | Code ('b') | Code ('B');
      Kind    : constant Frame_Kind :=
        (if Line (1) in Code ('r') | Code ('R') then Remote else Data);
      Header  : constant Positive := 1 + Id_Digits (Format) + 1;
      --  Where the digit of the length stands.
      Id_Bits : Interfaces.Unsigned_64 := 0;
      Length  : Fd_Frames.Fd_Length;
      Place   : Positive;
      Bytes   : Fd_Frames.Fd_Bytes := (others => 0);
      Bits    : Interfaces.Unsigned_64 := 0;
   begin
      Found := False;
      F     := Any_Frames.Null_Any_Frame;
      if Count < Header
        or else not (for all I in 2 .. Count => Is_Digit (Line (I)))
      then
         return;
      end if;
      for I in 2 .. Header - 1 loop
         Id_Bits := 16 * Id_Bits
           + Interfaces.Unsigned_64 (Digit (Line (I)));
      end loop;
      Length := Fd_Frames.Length_Of
        (Fd_Frames.Length_Code (Digit (Line (Header))));
      if Id_Bits > Interfaces.Unsigned_64 (Identifier'Last)
        or else not Fits (Identifier (Id_Bits), Format)
        or else (Length > 8 and then not Is_Fd)
        or else Count /=
          Header + (if Kind = Data then 2 * Length else 0)
      then
         return;
      end if;
      Found := True;
      if Kind = Remote then
         F := Any_Frames.To_Any
           (Remote_Frame (Identifier (Id_Bits), Format, Length));
         return;
      end if;
      for I in 0 .. Length - 1 loop
         Place     := Header + 1 + 2 * I;
         Bytes (I) :=
           16 * Digit (Line (Place)) + Digit (Line (Place + 1));
      end loop;
      if Is_Fd then
         F := Any_Frames.To_Any
           (Fd_Frames.Fd_Data_Frame
              (Identifier (Id_Bits), Format, Length, Bytes,
               (if Line (1) in Code ('b') | Code ('B')
                then Fd_Frames.Switched_Rate
                else Fd_Frames.Constant_Rate)));
      else
         for I in 0 .. Length - 1 loop
            Bits := Bits or Interfaces.Shift_Left
              (Interfaces.Unsigned_64 (Bytes (I)), 8 * I);
         end loop;
         F := Any_Frames.To_Any
           (Data_Frame (Identifier (Id_Bits), Format, Length, Bits));
      end if;
   end Read_Frame;

   ---------------
   -- Read_Line --
   ---------------

   procedure Read_Line
     (Line   : Line_Bytes;
      Count  : Content_Length;
      Result : out Outcome;
      F      : out Any_Frames.Any_Frame)
   is
      Found : Boolean;
   begin
      F := Any_Frames.Null_Any_Frame;
      if Count = 0 then
         Result := Empty_Line;
      elsif Line (1) in Code ('t') | Code ('T') | Code ('r') | Code ('R')
                      | Code ('d') | Code ('D') | Code ('b') | Code ('B')
      then
         Read_Frame (Line, Count, Found, F);
         Result := (if Found then Frame_Line else Rejected_Line);
      elsif Count = 1 and then Line (1) = Code ('O') then
         Result := Open_Channel;
      elsif Count = 1 and then Line (1) = Code ('C') then
         Result := Close_Channel;
      elsif Count = 1 and then Line (1) = Code ('V') then
         Result := Version_Query;
      elsif Count = 1 and then Line (1) = Code ('N') then
         Result := Serial_Query;
      elsif Settings_Are_Sound (Line, Count)
        or else (Count = 1 and then Line (1) in Code ('z') | Code ('Z'))
      then
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
      Last : out Line_Length)
   is
      Letter : constant Character :=
        (if F.Family = Any_Frames.Flexible
         then (if F.Fd.Rate = Fd_Frames.Switched_Rate then 'b' else 'd')
         elsif F.Plain.Kind = Data then 't'
         else 'r');
      Format       : constant Frame_Format := Any_Frames.Format (F);
      Digits_Of_Id : constant Positive := Id_Digits (Format);
      Header       : constant Positive := 1 + Digits_Of_Id + 1;
      Id_Bits      : constant Interfaces.Unsigned_64 :=
        Interfaces.Unsigned_64 (Any_Frames.Id (F));
      Length       : constant Fd_Frames.Fd_Length :=
        (if F.Family = Any_Frames.Flexible then F.Fd.Length
         else F.Plain.Length);
      Value        : Byte_Value;
   begin
      Line     := (others => 0);
      Line (1) := Code (Letter) - (if Format = Standard then 0 else Capital);
      for I in 1 .. Digits_Of_Id loop
         Line (1 + I) := Image
           (Digit_Value
              (Interfaces.Shift_Right (Id_Bits, 4 * (Digits_Of_Id - I))
               and 15));
      end loop;
      Line (Header) := Image (Digit_Value (Fd_Frames.Code (Length)));
      Last          := Header;
      if F.Family = Any_Frames.Flexible or else F.Plain.Kind = Data then
         for I in 0 .. Length - 1 loop
            Value :=
              (if F.Family = Any_Frames.Flexible
               then Fd_Frames.Byte (F.Fd, I)
               else Can.Byte (F.Plain, I));
            Line (Header + 1 + 2 * I) := Image (Value / 16);
            Line (Header + 2 + 2 * I) := Image (Value mod 16);
         end loop;
         Last := Header + 2 * Length;
      end if;
      Last        := Last + 1;
      Line (Last) := Carriage_Return;
   end Format_Line;

end Ravenchart.Can.Slcan;
