--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Codecs of a robot, and lengths of time in ticks: the lines are the same on
--  every machine. Contracts are executed.

with Cartesian_Robot.Codecs;
with Interfaces;
with Lines;
with Ravenchart.Clock_Ticks;

procedure Codec_Lines is
   use type Cartesian_Robot.Position;
   use type Cartesian_Robot.Robot_Order;
   use type Interfaces.Unsigned_64;
   use type Ravenchart.Nanoseconds;

   package Codec renames Cartesian_Robot.Codecs.Type_Robot_Order;

   package Of_10_Ns is new Ravenchart.Clock_Ticks (100_000_000);
   package Of_333_Mhz is new Ravenchart.Clock_Ticks (333_333_343);

   Seed : Interfaces.Unsigned_64 := 1;

   procedure Draw (Value : out Interfaces.Unsigned_64);
   --  The next number of a fixed sequence (Knuth's MMIX).

   procedure Put (Value : Interfaces.Unsigned_64);
   --  Write Value in hexadecimal, and a blank.

   procedure New_Line;

   procedure Put_Order (Word : Interfaces.Unsigned_64);
   --  What a word stands for, and what that is packed to.

   procedure Put_Time (Length : Ravenchart.Nanoseconds);
   --  Length in ticks of two clocks, and back.

   ----------
   -- Draw --
   ----------

   procedure Draw (Value : out Interfaces.Unsigned_64) is
   begin
      Seed  := Seed * 6_364_136_223_846_793_005 + 1_442_695_040_888_963_407;
      Value := Seed;
   end Draw;

   ---------
   -- Put --
   ---------

   procedure Put (Value : Interfaces.Unsigned_64) is
      Digit : Natural;
   begin
      for Place in reverse 0 .. 15 loop
         Digit := Natural (Interfaces.Shift_Right (Value, 4 * Place) and 15);
         Lines.Put
           (Character'Val
              (Digit
               + (if Digit < 10
                  then Character'Pos ('0')
                  else Character'Pos ('a') - 10)));
      end loop;
      Lines.Put (' ');
   end Put;

   --------------
   -- New_Line --
   --------------

   procedure New_Line is
   begin
      Lines.Put (ASCII.LF);
   end New_Line;

   ---------------
   -- Put_Order --
   ---------------

   procedure Put_Order (Word : Interfaces.Unsigned_64) is
      Item  : Cartesian_Robot.Robot_Order;
      Again : Cartesian_Robot.Robot_Order;
      Valid : Boolean;
   begin
      Codec.Unpack (Word, Item, Valid);
      Put (Word);
      Put (Boolean'Pos (Valid));
      Put (Cartesian_Robot.Order_Kind'Pos (Item.Kind));
      Put (Interfaces.Unsigned_64 (Item.X - Cartesian_Robot.Position'First));
      Put (Codec.Pack (Item));
      Codec.Unpack (Codec.Pack (Item), Again, Valid);
      Put (Boolean'Pos (Valid and then Again = Item));
      New_Line;
   end Put_Order;

   --------------
   -- Put_Time --
   --------------

   procedure Put_Time (Length : Ravenchart.Nanoseconds) is
      First  : constant Of_10_Ns.Tick_Span := Of_10_Ns.To_Ticks (Length);
      Second : constant Of_333_Mhz.Tick_Span := Of_333_Mhz.To_Ticks (Length);
   begin
      Put (Interfaces.Unsigned_64 (First.Minutes));
      Put (Interfaces.Unsigned_64 (First.Ticks));
      Put (Interfaces.Unsigned_64 (Second.Ticks));
      Put (Interfaces.Unsigned_64
             (Of_333_Mhz.To_Nanoseconds (Second) - Length));
      New_Line;
   end Put_Time;

   Word : Interfaces.Unsigned_64;

begin
   for Sample in 1 .. 200 loop
      Draw (Word);
      Put_Order (Word and 16#07FF_FFFF_FFFF_FFFF#);
      Put_Order (Word and 16#03FF_FFBF_FFFF_FFFF#);
      Put_Time (Ravenchart.Nanoseconds (Word and 2**61 - 1));
   end loop;
end Codec_Lines;
