--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  CAN0 and CAN1 of Zynq UltraScale+ on one bus: every kind of frame, and a
--  receive FIFO over its brim. One line for each fact.

with Interfaces;
with Lines;
with Ravenchart.Can;
with Ravenchart.Can.Xcan_Cores;
with Ravenchart.Can.Xcan_Frames;
with Ravenchart.Can.Xcan_Registers;

procedure Can_Pair is
   use type Interfaces.Unsigned_32;
   use type Interfaces.Unsigned_64;
   use type Ravenchart.Can.Controller_State;
   use type Ravenchart.Can.Frame_Format;
   use type Ravenchart.Can.Frame_Kind;
   use type Ravenchart.Can.Identifier;

   package Registers renames Ravenchart.Can.Xcan_Registers;
   package Frames renames Ravenchart.Can.Xcan_Frames;

   package Can_0 is new Ravenchart.Can.Xcan_Cores (16#FF06_0000#);
   package Can_1 is new Ravenchart.Can.Xcan_Cores (16#FF07_0000#);

   Clock : constant := 100_000_000;
   --  Of the controllers.

   procedure Put (Text : String);

   procedure Check (Fact : String; Holds : Boolean);

   function Sample (Number : Natural) return Ravenchart.Can.Frame;
   --  Frames of both formats, data and remote, of every length.

   function Same (Left, Right : Ravenchart.Can.Frame) return Boolean
   is (Left.Id = Right.Id
       and then Left.Format = Right.Format
       and then Left.Kind = Right.Kind
       and then Left.Length = Right.Length
       and then Ravenchart.Can.Payload (Left)
                = Ravenchart.Can.Payload (Right));

   function Waits return Boolean;
   --  Is there a frame in the receive FIFO of CAN1?

   ---------
   -- Put --
   ---------

   procedure Put (Text : String) is
   begin
      for C of Text loop
         Lines.Put (C);
      end loop;
   end Put;

   -----------
   -- Check --
   -----------

   procedure Check (Fact : String; Holds : Boolean) is
   begin
      if not Holds then
         Put ("not ");
      end if;
      Put ("ok ");
      Put (Fact);
      Lines.Put (ASCII.LF);
   end Check;

   ------------
   -- Sample --
   ------------

   function Sample (Number : Natural) return Ravenchart.Can.Frame is
      Mark   : constant Interfaces.Unsigned_64 :=
        16#0123_4567_89AB_CDEF# + Interfaces.Unsigned_64 (Number);
      Id     : constant Ravenchart.Can.Identifier :=
        (if Number mod 2 = 0
         then Ravenchart.Can.Identifier (Number)
         else 16#1ABC_D000# + Ravenchart.Can.Identifier (Number));
      Format : constant Ravenchart.Can.Frame_Format :=
        (if Number mod 2 = 0
         then Ravenchart.Can.Standard else Ravenchart.Can.Extended);
      Length : constant Ravenchart.Can.Data_Length := Number mod 9;
   begin
      return
        (if Number mod 5 = 4
         then Ravenchart.Can.Remote_Frame (Id, Format, Length)
         else Ravenchart.Can.Data_Frame (Id, Format, Length, Mark));
   end Sample;

   -----------
   -- Waits --
   -----------

   function Waits return Boolean is
      Causes : Registers.Word;
   begin
      --  The cause comes again as long as there is a frame.
      Can_1.Write (Registers.Icr, Registers.Receive_Not_Empty);
      Can_1.Read (Registers.Isr, Causes);
      return (Causes and Registers.Receive_Not_Empty) /= 0;
   end Waits;

   First  : Boolean;
   Second : Boolean;
   Right  : Boolean := True;
   Words  : Registers.Word;
   Item   : Frames.Image;
   Count  : Natural := 0;

begin
   Can_0.Configure (Clock, 500_000, First);
   Can_1.Configure (Clock, 500_000, Second);
   Check ("both have their bit rate", First and then Second);
   Can_0.Read (Registers.Sr, Words);
   Check
     ("a controller that is enabled is error-active",
      Registers.State_Of (Words) = Ravenchart.Can.Error_Active
      and then not Registers.Is_Configured (Words));
   Check ("nothing waits at first", not Waits);

   for Number in 0 .. 99 loop
      Can_0.Write_Frame (Frames.Image_Of (Sample (Number)));
      Right := Right and then Waits;
      Can_1.Read_Frame (Item);
      Right := Right and then Same (Frames.Frame_Of (Item), Sample (Number));
   end loop;
   Check ("100 frames of every kind arrive as they were sent", Right);
   Check ("nothing is left", not Waits);

   for Number in 1 .. 80 loop
      Can_0.Write_Frame (Frames.Image_Of (Sample (Number)));
   end loop;
   Can_1.Read (Registers.Isr, Words);
   Check
     ("a FIFO over its brim says so",
      (Words and Registers.Receive_Overflow) /= 0);
   Right := True;
   while Waits loop
      Can_1.Read_Frame (Item);
      Count := Count + 1;
      Right := Right and then Same (Frames.Frame_Of (Item), Sample (Count));
   end loop;
   Check
     ("it keeps the oldest 64 frames in order",
      Right and then Count = Registers.Fifo_Depth);

   Can_1.Configure (Clock, 333, First);
   Can_1.Read (Registers.Sr, Words);
   Check
     ("a bit rate that cannot be had leaves a controller in reset",
      not First
      and then Registers.Is_Configured (Words)
      and then Registers.State_Of (Words) = Ravenchart.Can.Stopped);
end Can_Pair;
