package body Ravenchart.Can.Fd_Frames
  with SPARK_Mode
is

   -------------------
   -- Fd_Data_Frame --
   -------------------

   function Fd_Data_Frame
     (Id     : Identifier;
      Format : Frame_Format;
      Length : Fd_Length;
      Bytes  : Fd_Bytes;
      Rate   : Bit_Rate_Use := Switched_Rate;
      Sender : Sender_State := Active_Sender) return Fd_Frame
   is
      Kept : Fd_Bytes := (others => 0);
   begin
      for I in 0 .. Length - 1 loop
         Kept (I) := Bytes (I);
         pragma Loop_Invariant
           (for all J in Fd_Index =>
              Kept (J) = (if J <= I then Bytes (J) else 0));
      end loop;
      return
        (Id     => Id,
         Format => Format,
         Rate   => Rate,
         Sender => Sender,
         Length => Length,
         Bytes  => Kept);
   end Fd_Data_Frame;

   -------------------
   -- Fd_Data_Frame --
   -------------------

   function Fd_Data_Frame
     (Id     : Identifier;
      Format : Frame_Format;
      Length : Fd_Length;
      Words  : Fd_Words;
      Rate   : Bit_Rate_Use) return Fd_Frame
   is
      Kept : Fd_Bytes := (others => 0);
   begin
      for I in 0 .. Length - 1 loop
         Kept (I) := Byte (Words, I);
         pragma Loop_Invariant
           (for all J in Fd_Index =>
              Kept (J) = (if J <= I then Byte (Words, J) else 0));
      end loop;
      return
        (Id     => Id,
         Format => Format,
         Rate   => Rate,
         Sender => Active_Sender,
         Length => Length,
         Bytes  => Kept);
   end Fd_Data_Frame;

   -----------
   -- Words --
   -----------

   function Words (F : Fd_Frame) return Fd_Words is
      Result : Fd_Words := (others => 0);
   begin
      for W in Word_Index loop
         Result (W) := Word (F, W);
         pragma Loop_Invariant
           (for all V in 0 .. W => Result (V) = Word (F, V));
      end loop;
      return Result;
   end Words;

end Ravenchart.Can.Fd_Frames;
