--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The order of the transmit buffers of a CTU CAN FD core.
--
--  Guarantees   no waiting frame stands behind one with a higher rank, and
--               equal ones keep their order. No buffer is lost. The priorities
--               for the core have the same order
--  Tasking      none: a line is a value
--  Timing       constant

with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Arbitration;
with Ravenchart.Can.Ctu_Registers;

package Ravenchart.Can.Ctu_Buffers
  with SPARK_Mode, Pure
is
   use type Any_Frames.Frame_Family;
   use type Arbitration.Rank;
   use type Ctu_Registers.Buffer;
   use type Ctu_Registers.Word;

   Room : constant := 4;
   --  Buffers that the driver uses.

   subtype Frame_Count is Natural range 0 .. Room;

   subtype Place is Frame_Count range 1 .. Room;
   --  A place in the line; the frame at place 1 is sent first.

   type Buffer_List is array (Place) of Ctu_Registers.Buffer;

   type Rank_List is array (Place) of Arbitration.Rank;

   type Line is record
      Waiting : Frame_Count := 0;
      Buffers : Buffer_List := (1, 2, 3, 4);
      Ranks   : Rank_List := (others => 0);
   end record
   with
     Predicate =>
       (for all A in Place =>
          (for all B in Place =>
             (if A /= B then Buffers (A) /= Buffers (B))))
       and then (for all P in 2 .. Waiting => Ranks (P - 1) <= Ranks (P));
   --  The first buffers hold the frames that wait, with their ranks; the
   --  others are free, and the next one is the first of them.

   function Urgency (F : Any_Frames.Any_Frame) return Arbitration.Rank
   is (Arbitration.Rank_Of
         ((Id     => Any_Frames.Id (F),
           Format => Any_Frames.Format (F),
           Kind   =>
             (if F.Family = Any_Frames.Classic then F.Plain.Kind else Data))))
   with Global => null;
   --  The rank of F in arbitration: the lower one is the more urgent.

   function Is_Same (A, B : Line; Here, There : Place) return Boolean
   is (A.Buffers (Here) = B.Buffers (There)
       and then A.Ranks (Here) = B.Ranks (There))
   with Ghost, Global => null;
   --  Is the frame of A at Here that of B at There?

   function Place_For (L : Line; Rank : Arbitration.Rank) return Place
   with
     Global => null,
     Pre    => L.Waiting < Room,
     Post   =>
       Place_For'Result <= L.Waiting + 1
       and then
         (if Place_For'Result > 1
          then L.Ranks (Place_For'Result - 1) <= Rank)
       and then
         (for all P in Place_For'Result .. L.Waiting => L.Ranks (P) > Rank);
   --  The place of a new frame: behind all that are at least as urgent.

   procedure Put
     (L    : in out Line;
      Rank : Arbitration.Rank;
      Into : out Ctu_Registers.Buffer)
   with
     Global => null,
     Pre    => L.Waiting < Room,
     Post   =>
       L.Waiting = L.Waiting'Old + 1
       and then Into = L.Buffers'Old (L.Waiting)
       and then L.Buffers (Place_For (L'Old, Rank)) = Into
       and then L.Ranks (Place_For (L'Old, Rank)) = Rank
       and then
         (for all P in 1 .. L.Waiting'Old =>
            Is_Same
              (L, L'Old,
               (if P < Place_For (L'Old, Rank) then P else P + 1), P));
   --  A frame of this rank goes to the buffer Into, which was free; the others
   --  keep their order.

   procedure Remove (L : in out Line; Gone : Place)
   with
     Global => null,
     Pre    => Gone <= L.Waiting,
     Post   =>
       L.Waiting = L.Waiting'Old - 1
       and then L.Buffers (Room) = L.Buffers'Old (Gone)
       and then
         (for all P in 1 .. L.Waiting =>
            Is_Same (L, L'Old, P, (if P < Gone then P else P + 1)));
   --  The frame at Gone waits no more: its buffer becomes the last free one.

   function Priorities (L : Line) return Ctu_Registers.Word
   with
     Global => null,
     Post   =>
       (for all P in Place =>
          Ctu_Registers.Priority_Of (Priorities'Result, L.Buffers (P))
          = Ctu_Registers.Word (Room + 1 - P));
   --  TX_PRIORITY by which the core sends the frames in the order of the line.

end Ravenchart.Can.Ctu_Buffers;
