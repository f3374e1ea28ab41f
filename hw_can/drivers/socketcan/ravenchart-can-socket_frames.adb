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

   -------------
   -- Item_Of --
   -------------

   function Item_Of (F : Frame) return Item is
      Id : Interfaces.Unsigned_32 := Interfaces.Unsigned_32 (F.Id);
   begin
      pragma Assert (Id <= Extended_Bits);
      if F.Format = Extended then
         Id := Id or Extended_Flag;
      end if;
      if F.Kind = Remote then
         Id := Id or Remote_Flag;
      end if;
      return
        (Id     => Id,
         Length => Interfaces.Unsigned_8 (F.Length),
         Data   =>
           (Byte (F, 0), Byte (F, 1), Byte (F, 2), Byte (F, 3),
            Byte (F, 4), Byte (F, 5), Byte (F, 6), Byte (F, 7)),
         others => 0);
   end Item_Of;

end Ravenchart.Can.Socket_Frames;
