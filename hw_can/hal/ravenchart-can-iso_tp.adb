--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Iso_Tp
  with SPARK_Mode
is

   function Word_Of
     (Item : Value_Bytes; Index : Fd_Frames.Word_Index)
      return Interfaces.Unsigned_64
   is (Payload_Of
         ((Item (8 * Index),
           Item (8 * Index + 1),
           Item (8 * Index + 2),
           Item (8 * Index + 3),
           Item (8 * Index + 4),
           Item (8 * Index + 5),
           Item (8 * Index + 6),
           Item (8 * Index + 7))));

   -------------
   -- Decoded --
   -------------

   function Decoded
     (Payload : Interfaces.Unsigned_64; Length : Data_Length) return Segment
   is
      Head   : constant Octet := Octet_Of (Payload, 0);
      Kind   : constant Octet := Interfaces.Shift_Right (Head, 4);
      Low    : constant Natural := Natural (Head and 16#0F#);
      Second : constant Octet := Octet_Of (Payload, 1);
   begin
      if Kind = 0 and then Low in 1 .. 7 and then Low < Length then
         return (Kind => Single, Length => Low, others => <>);
      elsif Kind = 1 and then Length = 8 then
         return
           (Kind   => First,
            Length => 256 * Low + Natural (Second),
            others => <>);
      elsif Kind = 2 and then Length >= 2 then
         return
           (Kind     => Consecutive,
            Sequence => Sequence_Number (Low),
            others   => <>);
      elsif Kind = 3 and then Length >= 3 then
         return
           (Kind       => Flow_Control,
            Status     =>
              (case Low is
                 when 0      => Continue_To_Send,
                 when 1      => Wait,
                 when 2      => Overflow,
                 when others => Invalid),
            Block      => Natural (Second),
            Separation => Separation_Of (Octet_Of (Payload, 2)),
            others     => <>);
      else
         return (others => <>);
      end if;
   end Decoded;

   --------------
   -- Words_Of --
   --------------

   function Words_Of (Item : Value_Bytes) return Fd_Frames.Fd_Words is
      Result : Fd_Frames.Fd_Words := (others => 0);
   begin
      for I in Result'Range loop
         Result (I) := Word_Of (Item, I);
         pragma Loop_Invariant
           (for all J in 0 .. I => Result (J) = Word_Of (Item, J));
      end loop;
      return Result;
   end Words_Of;

   --------------
   -- Bytes_Of --
   --------------

   function Bytes_Of (Item : Fd_Frames.Fd_Words) return Value_Bytes is
      Result : Value_Bytes := (others => 0);
   begin
      for I in Result'Range loop
         Result (I) := Fd_Frames.Byte (Item, I);
         pragma Loop_Invariant
           (for all J in 0 .. I => Result (J) = Fd_Frames.Byte (Item, J));
      end loop;
      return Result;
   end Bytes_Of;

end Ravenchart.Can.Iso_Tp;
