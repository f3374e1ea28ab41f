--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Socket_Frames
  with SPARK_Mode
is
   function Word (D : Data_Bytes) return Interfaces.Unsigned_64
   is (Interfaces.Unsigned_64 (D (0))
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (D (1)), 8)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (D (2)), 16)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (D (3)), 24)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (D (4)), 32)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (D (5)), 40)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (D (6)), 48)
       or Interfaces.Shift_Left (Interfaces.Unsigned_64 (D (7)), 56));
   --  The bytes as one word, byte 0 lowest.

   function Id_Word
     (Id : Identifier; Format : Frame_Format; Kind : Frame_Kind)
      return Interfaces.Unsigned_32
   with
     Pre  => Fits (Id, Format),
     Post =>
       (Id_Word'Result and Extended_Bits) = Interfaces.Unsigned_32 (Id)
       and then (Id_Word'Result and Error_Flag) = 0
       and then ((Id_Word'Result and Extended_Flag) /= 0)
                = (Format = Extended)
       and then ((Id_Word'Result and Remote_Flag) /= 0) = (Kind = Remote);

   --------------
   -- Frame_Of --
   --------------

   function Frame_Of (I : Item) return Frame
   is ((Id     => Identifier (I.Id and Extended_Bits),
        Format =>
          (if (I.Id and Extended_Flag) /= 0 then Extended else Standard),
        Kind   => (if (I.Id and Remote_Flag) /= 0 then Remote else Data),
        Length => Natural (I.Length),
        Bits   => (if (I.Id and Remote_Flag) /= 0 then 0 else Word (I.Data))));

   -----------------
   -- Fd_Frame_Of --
   -----------------

   function Fd_Frame_Of (I : Item) return Fd_Frames.Fd_Frame
   is (Fd_Frames.Fd_Data_Frame
         (Id     => Identifier (I.Id and Extended_Bits),
          Format =>
            (if (I.Id and Extended_Flag) /= 0 then Extended else Standard),
          Length => Natural (I.Length),
          Bytes  => Fd_Frames.Fd_Bytes (I.Data),
          Rate   =>
            (if (I.Flags and Switch_Flag) /= 0
             then Fd_Frames.Switched_Rate
             else Fd_Frames.Constant_Rate),
          Sender =>
            (if (I.Flags and Passive_Flag) /= 0
             then Fd_Frames.Passive_Sender
             else Fd_Frames.Active_Sender)));

   -------------
   -- Id_Word --
   -------------

   function Id_Word
     (Id : Identifier; Format : Frame_Format; Kind : Frame_Kind)
      return Interfaces.Unsigned_32
   is
      Bits : Interfaces.Unsigned_32 := Interfaces.Unsigned_32 (Id);
   begin
      pragma Assert (Bits <= Extended_Bits);
      if Format = Extended then
         Bits := Bits or Extended_Flag;
      end if;
      if Kind = Remote then
         Bits := Bits or Remote_Flag;
      end if;
      return Bits;
   end Id_Word;

   -------------
   -- Item_Of --
   -------------

   function Item_Of (F : Frame) return Item
   is ((Id     => Id_Word (F.Id, F.Format, F.Kind),
        Length => Interfaces.Unsigned_8 (F.Length),
        Data   =>
          (0 => Byte (F, 0), 1 => Byte (F, 1),
           2 => Byte (F, 2), 3 => Byte (F, 3),
           4 => Byte (F, 4), 5 => Byte (F, 5),
           6 => Byte (F, 6), 7 => Byte (F, 7), others => 0),
        others => 0));

   -------------
   -- Item_Of --
   -------------

   function Item_Of (F : Fd_Frames.Fd_Frame) return Item is
      Result : Item :=
        (Id     => Id_Word (F.Id, F.Format, Data),
         Length => Interfaces.Unsigned_8 (F.Length),
         Flags  =>
           Fd_Flag
           or (if F.Rate = Fd_Frames.Switched_Rate then Switch_Flag else 0)
           or (if F.Sender = Fd_Frames.Passive_Sender
               then Passive_Flag else 0),
         others => <>);
   begin
      for B in Fd_Frames.Fd_Index loop
         Result.Data (B) := Fd_Frames.Byte (F, B);
         pragma Loop_Invariant
           (for all C in 0 .. B => Result.Data (C) = Fd_Frames.Byte (F, C));
      end loop;
      return Result;
   end Item_Of;

end Ravenchart.Can.Socket_Frames;
