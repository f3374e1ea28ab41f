--  The transmit buffer of one controller: what is still to be sent.
--
--  Guarantees   a FIFO buffer keeps the order of the requests; in one by
--               priority no frame stands behind a less urgent one, and equal
--               ones keep their order; nothing else moves or is lost
--  Tasking      none: one owner for each Buffer
--  Timing       linear in what is held

with Interfaces;
with Ravenchart.Can.Arbitration;
with Ravenchart.Can.Bus_Frames;

package Ravenchart.Can.Transmit_Buffers
  with SPARK_Mode, Pure
is
   use type Arbitration.Rank;

   type Discipline is (By_Priority, First_In_First_Out);
   --  Which of its frames a controller offers to the bus.

   Room : constant := 1_024;
   --  Frames that a buffer holds.

   subtype Slot_Count is Natural range 0 .. Room;

   subtype Slot_Index is Slot_Count range 1 .. Room;
   --  Slot 1 is the head: what is offered next.

   type Request is record
      Frame : Bus_Frames.Bus_Frame;
      Tag   : Interfaces.Unsigned_32 := 0;
      Since : Nanoseconds := 0;
   end record;
   --  A frame, a number by which its owner knows it, and when it was queued.

   type Request_List is array (Slot_Index) of Request;

   type Buffer is record
      Order : Discipline := First_In_First_Out;
      Count : Slot_Count := 0;
      Slots : Request_List;
   end record;
   --  What stands beyond Count means nothing.

   function Rank_At
     (B : Buffer; Index : Slot_Index) return Arbitration.Rank
   is (Arbitration.Rank_Of
         (Bus_Frames.Contender_Of (B.Slots (Index).Frame)))
   with Global => null;
   --  The place in arbitration of what is there.

   function Is_Ordered (B : Buffer) return Boolean
   is (if B.Order = By_Priority
       then
         (for all I in 2 .. B.Count =>
            Rank_At (B, I - 1) <= Rank_At (B, I)))
   with Global => null;
   --  Does nothing urgent stand behind something less urgent?

   procedure Head_Is_First (B : Buffer)
   with
     Ghost,
     Global => null,
     Pre    => B.Order = By_Priority and then Is_Ordered (B),
     Post   =>
       (for all I in 1 .. B.Count => Rank_At (B, 1) <= Rank_At (B, I));
   --  What is offered is the most urgent of all.

   function Place_For
     (B : Buffer; Frame : Bus_Frames.Bus_Frame) return Slot_Index
   with
     Global => null,
     Pre    => B.Count < Room and then Is_Ordered (B),
     Post   =>
       Place_For'Result <= B.Count + 1
       and then
         (if B.Order = First_In_First_Out
          then Place_For'Result = B.Count + 1
          else
            (if Place_For'Result > 1
             then
               Rank_At (B, Place_For'Result - 1)
               <= Arbitration.Rank_Of (Bus_Frames.Contender_Of (Frame)))
            and then
              (for all I in Place_For'Result .. B.Count =>
                 Rank_At (B, I)
                 > Arbitration.Rank_Of (Bus_Frames.Contender_Of (Frame))));
   --  Where Frame goes: behind all that is as urgent.

   procedure Put (B : in out Buffer; Item : Request)
   with
     Global => null,
     Pre    => B.Count < Room and then Is_Ordered (B),
     Post   =>
       Is_Ordered (B)
       and then B.Order = B.Order'Old
       and then B.Count = B.Count'Old + 1
       and then B.Slots (Place_For (B'Old, Item.Frame)) = Item
       and then
         (for all I in 1 .. B.Count'Old =>
            B.Slots
              (if I < Place_For (B'Old, Item.Frame) then I else I + 1)
            = B.Slots'Old (I));
   --  Queue Item; what was there keeps its order.

   procedure Drop_Head (B : in out Buffer)
   with
     Global => null,
     Pre    => B.Count > 0 and then Is_Ordered (B),
     Post   =>
       Is_Ordered (B)
       and then B.Order = B.Order'Old
       and then B.Count = B.Count'Old - 1
       and then
         (for all I in 1 .. B.Count => B.Slots (I) = B.Slots'Old (I + 1));
   --  The head was sent, or is not to be sent.

   procedure Clear (B : in out Buffer)
   with
     Global => null,
     Post   => B.Count = 0 and then B.Order = B.Order'Old;
   --  Nothing is to be sent any more.

end Ravenchart.Can.Transmit_Buffers;
