--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Frames from one CTU CAN FD core to another on the same bus, by their
--  registers: every length, format and bit rate, each sent once the one
--  before has come. Both cores are free: no driver has them.

with Ctu_Pair;
with Facts;
with Interfaces;
with Ravenchart.Can;
with Ravenchart.Can.Arbitration;
with Ravenchart.Can.Ctu_Buffers;
with Ravenchart.Can.Ctu_Frames;
with Ravenchart.Can.Ctu_Registers;
with Ravenchart.Can.Fd_Frames;

procedure Test_Ctu_Cores is
   use Ravenchart.Can;
   use Ravenchart.Can.Ctu_Frames;
   use Ravenchart.Can.Fd_Frames;
   use type Interfaces.Unsigned_32;

   package Near renames Ctu_Pair.Near;
   package Far renames Ctu_Pair.Far;
   package Registers renames Ravenchart.Can.Ctu_Registers;

   Base : constant Frame_Format := Ravenchart.Can.Standard;
   --  The literal alone would be hidden by package Standard.

   Bits : constant Interfaces.Unsigned_64 := 16#8877_6655_4433_2211#;

   procedure Cross (Sent : Image; I : out Image; Good : out Boolean);
   --  Send a frame from the first buffer, and take it at the other core.

   procedure Check_Fd (Format : Frame_Format; Rate : Bit_Rate_Use);
   --  FD frames of each length.

   procedure Check_Classic (Format : Frame_Format; Kind : Frame_Kind);
   --  Classic frames of each length.

   procedure Check_Order;
   --  The four buffers, ready at once, are sent in the order of their line.

   -----------
   -- Cross --
   -----------

   procedure Cross (Sent : Image; I : out Image; Good : out Boolean) is
   begin
      Near.Write_Frame (1, Sent);
      Near.Write (Registers.Tx_Command, Registers.Set_Ready (1));
      Ctu_Pair.Come (I, Good);
   end Cross;

   --------------
   -- Check_Fd --
   --------------

   procedure Check_Fd (Format : Frame_Format; Rate : Bit_Rate_Use) is
      Bytes : Fd_Bytes;
      Sent  : Fd_Frame;
      I     : Image;
      Come  : Boolean;
      Good  : Natural := 0;
   begin
      for Code in Length_Code loop
         for B in Fd_Index loop
            Bytes (B) := Interfaces.Unsigned_8 (255 - 3 * B mod 256);
         end loop;
         Sent := Fd_Data_Frame
           ((if Format = Base then 16#7F0# else 16#1FFF_FFF0#)
            + Identifier (Code),
            Format, Length_Of (Code), Bytes, Rate);
         Cross (Image_Of (Sent), I, Come);
         if Come and then Is_Fd (I) and then Fd_Frame_Of (I) = Sent then
            Good := Good + 1;
         end if;
      end loop;
      Facts.Check
        ("FD frames of 0 to 64 bytes cross, " & Format'Image & ", "
         & Rate'Image & ":" & Good'Image & " of 16", Good = 16);
   end Check_Fd;

   -------------------
   -- Check_Classic --
   -------------------

   procedure Check_Classic (Format : Frame_Format; Kind : Frame_Kind) is
      Sent : Frame;
      I    : Image;
      Come : Boolean;
      Good : Natural := 0;
   begin
      for Length in Data_Length loop
         Sent :=
           (if Kind = Data
            then Data_Frame (16#123#, Format, Length, Bits)
            else Remote_Frame (16#123#, Format, Length));
         Cross (Image_Of (Sent), I, Come);
         if Come and then not Is_Fd (I) and then Frame_Of (I) = Sent then
            Good := Good + 1;
         end if;
      end loop;
      Facts.Check
        ("classic frames of 0 to 8 bytes cross, " & Format'Image & ", "
         & Kind'Image & ":" & Good'Image & " of 9", Good = 9);
   end Check_Classic;

   -----------------
   -- Check_Order --
   -----------------

   procedure Check_Order is
      Line     : Ctu_Buffers.Line;
      Slot     : Registers.Buffer;
      Rank     : Identifier;
      All_Four : Registers.Word;
      I        : Image;
      Here     : Boolean;
      Good     : Boolean := True;
   begin
      for Turn in Identifier range 1 .. 4 loop
         Line     := (others => <>);
         All_Four := 0;
         for Nth in Identifier range 1 .. 4 loop
            Rank := (Nth + Turn) mod 4;
            Ctu_Buffers.Put (Line, Arbitration.Rank (Rank), Slot);
            Near.Write_Frame
              (Slot, Image_Of (Data_Frame (16#40# - Rank, Base, 0, 0)));
            All_Four := All_Four or Registers.Set_Ready (Slot);
         end loop;
         Near.Write (Registers.Tx_Priority, Ctu_Buffers.Priorities (Line));
         Near.Write (Registers.Tx_Command, All_Four);
         for Nth in 0 .. Identifier (3) loop
            Ctu_Pair.Come (I, Here);
            Good := Good and then Here and then Id_Of (I) = 16#40# - Nth;
         end loop;
      end loop;
      Facts.Check ("four buffers are sent in the order of the line", Good);
   end Check_Order;

   Opened, Other, Good, Right : Boolean;
begin
   Near.Open (Opened);
   Far.Open (Other);
   Facts.Check ("there are registers", Opened and then Other);
   Ctu_Pair.Start_Near (Good);
   Ctu_Pair.Start_Far (Right);
   Facts.Check ("there are two cores", Good and then Right);
   for Format in Frame_Format loop
      for Kind in Frame_Kind loop
         Check_Classic (Format, Kind);
      end loop;
      for Rate in Bit_Rate_Use loop
         Check_Fd (Format, Rate);
      end loop;
   end loop;
   Check_Order;
   Facts.Finish;
end Test_Ctu_Cores;
