--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The transmit buffer of one controller: the frames still to be sent.
--
--  Guarantees   a FIFO buffer keeps the order of the requests. In a buffer by
--               priority no frame stands behind a less urgent one, and equal
--               ones keep their order. No other frame moves or is lost
--  Tasking      none: one owner for each Buffer
--  Timing       linear in the number of frames

with Interfaces;
with Ravenchart.Can.Arbitration;
with Ravenchart.Can.Bus_Frames;

package Ravenchart.Can.Transmit_Buffers
  with SPARK_Mode, Pure
is
   use type Arbitration.Rank;

   type Discipline is (By_Priority, First_In_First_Out);
   --  The order in which a controller offers its frames to the bus.

   Room : constant := 1_024;
   --  Frames that a buffer holds.

   subtype Slot_Count is Natural range 0 .. Room;

   subtype Slot_Index is Slot_Count range 1 .. Room;
   --  Slot 1 is the head: the next offer.

   type Request is record
      Frame : Bus_Frames.Bus_Frame;
      Tag   : Interfaces.Unsigned_32 := 0;
      Since : Nanoseconds := 0;
   end record;
   --  A frame, the number by which its owner knows it, and the time at which
   --  it was queued.

   function Rank_Of (R : Request) return Arbitration.Rank
   is (Arbitration.Rank_Of (Bus_Frames.Contender_Of (R.Frame)))
   with Global => null;
   --  The rank of its frame in arbitration.

   type Buffer is private
   with
     Default_Initial_Condition =>
       Order (Buffer) = First_In_First_Out and then Count (Buffer) = 0;
   --  In a buffer by priority no frame stands behind a less urgent one.

   function Order (B : Buffer) return Discipline
   with Global => null;
   --  The order in which it offers its frames.

   function Count (B : Buffer) return Slot_Count
   with Global => null;
   --  The number of its frames.

   function Item (B : Buffer; Index : Slot_Index) return Request
   with Global => null, Pre => Index <= Count (B);
   --  The frame at Index.

   function Rank_At
     (B : Buffer; Index : Slot_Index) return Arbitration.Rank
   is (Rank_Of (Item (B, Index)))
   with Global => null, Pre => Index <= Count (B);
   --  The rank in arbitration of that frame.

   procedure Head_Is_First (B : Buffer)
   with
     Ghost,
     Global => null,
     Pre    => Order (B) = By_Priority,
     Post   =>
       (for all I in 1 .. Count (B) => Rank_At (B, 1) <= Rank_At (B, I));
   --  The head is the most urgent frame of all.

   function Place_For
     (B : Buffer; What : Request) return Slot_Index
   with
     Global => null,
     Pre    => Count (B) < Room,
     Post   =>
       Place_For'Result <= Count (B) + 1
       and then
         (if Order (B) = First_In_First_Out
          then Place_For'Result = Count (B) + 1
          else
            (if Place_For'Result > 1
             then Rank_At (B, Place_For'Result - 1) <= Rank_Of (What))
            and then
              (for all I in Place_For'Result .. Count (B) =>
                 Rank_At (B, I) > Rank_Of (What)));
   --  The slot of a new frame: behind all frames that are at least as urgent.

   procedure Put (B : in out Buffer; What : Request)
   with
     Global => null,
     Pre    => Count (B) < Room,
     Post   =>
       Order (B) = Order (B'Old)
       and then Count (B) = Count (B'Old) + 1
       and then Item (B, Place_For (B'Old, What)) = What
       and then
         (for all I in 1 .. Count (B'Old) =>
            Item
              (B, (if I < Place_For (B'Old, What) then I else I + 1))
            = Item (B'Old, I));
   --  Queue a frame; the others keep their order.

   procedure Drop_Head (B : in out Buffer)
   with
     Global => null,
     Pre    => Count (B) > 0,
     Post   =>
       Order (B) = Order (B'Old)
       and then Count (B) = Count (B'Old) - 1
       and then
         (for all I in 1 .. Count (B) => Item (B, I) = Item (B'Old, I + 1));
   --  Remove the head, which was sent or is withdrawn.

   procedure Clear (B : in out Buffer)
   with
     Global => null,
     Post   => Count (B) = 0 and then Order (B) = Order (B'Old);
   --  Remove all frames.

   procedure Reset (B : in out Buffer; Order : Discipline)
   with
     Global => null,
     Post   =>
       Count (B) = 0 and then Transmit_Buffers.Order (B) = Order;
   --  Remove all frames, and use this order from here on.

private

   type Request_List is array (Slot_Index) of Request;

   type Buffer is record
      Order : Discipline := First_In_First_Out;
      Count : Slot_Count := 0;
      Slots : Request_List;
   end record
   with
     Type_Invariant =>
       (if Order = By_Priority then Is_Ordered (Slots, Count));
   --  Slots beyond Count have no meaning.

   function Is_Ordered
     (Slots : Request_List; Count : Slot_Count) return Boolean
   is (for all I in 2 .. Count =>
         Rank_Of (Slots (I - 1)) <= Rank_Of (Slots (I)))
   with Global => null;
   --  Does no frame stand behind a less urgent one?

   function Order (B : Buffer) return Discipline
   is (B.Order);

   function Count (B : Buffer) return Slot_Count
   is (B.Count);

   function Item (B : Buffer; Index : Slot_Index) return Request
   is (B.Slots (Index));

end Ravenchart.Can.Transmit_Buffers;
