--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Every interleaving of the writer and the reader of a board that two cores
--  share (Ravenchart.Crossing_Boards). Each procedure is one step of one of
--  the two, in the order of the statements there. A step accesses one atomic
--  object, or begins to access a slot: that access lasts until the next step
--  of the same task. Each step keeps the invariant, whatever step comes next:
--  so it holds in every interleaving (Owicki and Gries 1976).
--
--  Guarantees   contract: no slot is read while it is written; the reader gets
--               the last value shown before Look or a later one, and never one
--               older than the one before
--  Assumptions  ASM-023, both tasks see the steps in one order

package Four_Slot_Steps
  with SPARK_Mode, Pure
is
   type Side is range 0 .. 1;

   type Number is range 0 .. 2**62;
   --  The values in the order in which they are written; 0 is the first one,
   --  which is there before.

   type Writer_Place is (Idle, Avoided, Filling, Half_Shown);
   --  The step that the writer did last.

   type Reader_Place is (Idle, Looked, Announced, Copying);
   --  The step that the reader did last. Copying begins with Choose.

   type Sides is array (Side) of Side;

   type Numbers is array (Side, Side) of Number;

   type Board is record
      --  Both tasks access these.
      Latest  : Side    := 0;
      Reading : Side    := 0;
      Newest  : Sides   := (others => 0);
      Slots   : Numbers := (others => (others => 0));

      --  Each task knows its own.
      Writer      : Writer_Place := Idle;
      Writer_Pair : Side         := 0;
      Writer_Half : Side         := 0;
      Reader      : Reader_Place := Idle;
      Reader_Pair : Side         := 0;
      Reader_Half : Side         := 0;

      --  Only the proof needs these.
      Written : Number := 0;
      --  The value that is written, or was written last.
      Shown   : Number := 0;
      --  The value whose Write has ended last.
      Asked   : Number := 0;
      --  Shown at the last Look.
      Got     : Number := 0;
      --  The value read last.
   end record;

   function Collides (B : Board) return Boolean
   is (B.Writer = Filling
       and then B.Reader = Copying
       and then B.Writer_Pair = B.Reader_Pair
       and then B.Writer_Half = B.Reader_Half);
   --  Is a slot read while it is written?

   function At_Latest (B : Board) return Number
   is (B.Slots (B.Latest, B.Newest (B.Latest)));

   function Of_Reader (B : Board) return Number
   is (B.Slots (B.Reader_Pair, B.Newest (B.Reader_Pair)));

   function Is_Sound (B : Board) return Boolean
   is (not Collides (B)
       and then B.Written < Number'Last
       and then B.Shown <= B.Written
       and then (for all P in Side =>
                   (for all H in Side => B.Slots (P, H) <= B.Written))

       --  The writer fills the half that is not shown. It has chosen a pair
       --  that was not announced, or else the pair is the one that is shown.
       and then (if B.Writer in Avoided | Filling
                 then B.Writer_Half /= B.Newest (B.Writer_Pair))
       and then (if B.Writer in Avoided | Filling
                   and then B.Reader = Copying
                   and then B.Writer_Pair = B.Reader_Pair
                 then B.Writer_Half /= B.Reader_Half)
       and then (if B.Writer = Filling
                 then B.Slots (B.Writer_Pair, B.Writer_Half) = B.Written)
       and then (if B.Writer = Half_Shown
                 then B.Slots (B.Writer_Pair, B.Newest (B.Writer_Pair))
                      = B.Written)
       and then (if B.Writer /= Idle and then B.Writer_Pair = B.Reading
                 then B.Latest = B.Reading)

       --  The reader has announced the pair that it reads.
       and then (if B.Reader = Looked and then B.Reader_Pair /= B.Reading
                 then B.Latest = B.Reader_Pair)
       and then (if B.Reader in Announced | Copying
                 then B.Reading = B.Reader_Pair)

       --  A value shown is never older than one shown or read before.
       and then At_Latest (B) >= B.Shown
       and then At_Latest (B) >= B.Got
       and then (if B.Reader in Looked | Announced
                 then Of_Reader (B) >= B.Asked
                      and then Of_Reader (B) >= B.Got
                      and then Of_Reader (B) <= At_Latest (B))
       and then (if B.Reader = Copying
                 then B.Slots (B.Reader_Pair, B.Reader_Half) >= B.Asked
                      and then B.Slots (B.Reader_Pair, B.Reader_Half) >= B.Got
                      and then B.Slots (B.Reader_Pair, B.Reader_Half)
                               <= At_Latest (B)));

   --  The writer

   procedure Avoid (B : in out Board)
   with
     Pre  => Is_Sound (B) and then B.Writer = Idle,
     Post => Is_Sound (B) and then B.Writer = Avoided;

   procedure Fill (B : in out Board)
   with
     Pre  =>
       Is_Sound (B)
       and then B.Writer = Avoided
       and then B.Written < Number'Last - 1,
     Post => Is_Sound (B) and then B.Writer = Filling;

   procedure Show_Half (B : in out Board)
   with
     Pre  => Is_Sound (B) and then B.Writer = Filling,
     Post => Is_Sound (B) and then B.Writer = Half_Shown;

   procedure Show_Pair (B : in out Board)
   with
     Pre  => Is_Sound (B) and then B.Writer = Half_Shown,
     Post =>
       Is_Sound (B) and then B.Writer = Idle and then B.Shown = B.Written;

   --  The reader

   procedure Look (B : in out Board)
   with
     Pre  => Is_Sound (B) and then B.Reader = Idle,
     Post =>
       Is_Sound (B) and then B.Reader = Looked and then B.Asked = B.Shown;

   procedure Announce (B : in out Board)
   with
     Pre  => Is_Sound (B) and then B.Reader = Looked,
     Post => Is_Sound (B) and then B.Reader = Announced;

   procedure Choose (B : in out Board)
   with
     Pre  => Is_Sound (B) and then B.Reader = Announced,
     Post => Is_Sound (B) and then B.Reader = Copying;

   procedure End_Copy (B : in out Board)
   with
     Pre  => Is_Sound (B) and then B.Reader = Copying,
     Post =>
       Is_Sound (B)
       and then B.Reader = Idle
       and then B.Got = B.Slots (B.Reader_Pair, B.Reader_Half)
       and then B.Got >= B.Asked
       and then B.Got >= B.Got'Old;

end Four_Slot_Steps;
