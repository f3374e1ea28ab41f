--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The faults that can be injected into one frame of the simulated bus.
--
--  Guarantees   without a fault, a frame arrives as it was sent, once and
--               at once
--  Tasking      none: faults are values
--  Timing       constant

with Interfaces;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Wire;

package Ravenchart.Can.Bus_Faults
  with SPARK_Mode, Pure
is
   use type Bus_Frames.Bus_Frame;
   use type Interfaces.Unsigned_8;

   type Fault_Kind is
     (None,
      Disturbed_Bit,
      Disturbed_End,
      Overload,
      Lost_Acknowledgement,
      Dropped,
      Delayed,
      Duplicated,
      Corrupted);
   --  Disturbed_Bit: a bit is read with the opposite level. Disturbed_End: the
   --  same for a bit of the end of frame or of the intermission. Overload: a
   --  receiver needs a delay of the next frame. Lost_Acknowledgement: the
   --  transmitter reads the acknowledgement slot recessive. The others are
   --  faults of a receiver, which the bus does not notice: the frame is lost,
   --  handed over late, or twice, or with changed data.

   Everyone : constant := 0;

   subtype Victim is Natural range 0 .. 255;
   --  All nodes, or one.

   type Fault is record
      Kind     : Fault_Kind := None;
      Node     : Victim := Everyone;
      Position : Wire.Bit_Index := 1;
      Late     : Nanoseconds := 0;
      Index    : Fd_Frames.Fd_Index := 0;
      Mask     : Interfaces.Unsigned_8 := 0;
   end record;
   --  Node: the node with the fault. Position of a disturbed bit: the bit, or
   --  the last of the end of frame when the frame has fewer. Position of a
   --  disturbed end: the bit, counted from the first of the end of frame; 8 to
   --  10 are the intermission. Position of an overload: the number of overload
   --  frames. Late: the delay. Index, Mask: the byte that changes, and its
   --  bits.

   No_Fault : constant Fault := (others => <>);

   function Is_Witness (F : Fault; Node : Positive) return Boolean
   is (F.Kind in Disturbed_Bit | Disturbed_End
       and then F.Node = Node)
   with Global => null;
   --  Is Node the only one that reads the disturbed bit?

   function Hits (F : Fault; Kind : Fault_Kind; Node : Positive)
     return Boolean
   is (F.Kind = Kind
       and then (F.Node = Everyone or else F.Node = Node))
   with Global => null;
   --  Does F have this effect on Node?

   subtype Copies is Natural range 0 .. 2;

   function Copies_For (F : Fault; Node : Positive) return Copies
   is (if Hits (F, Dropped, Node) then 0
       elsif Hits (F, Duplicated, Node) then 2
       else 1)
   with Global => null;
   --  How often Node receives the frame.

   function Lateness (F : Fault; Node : Positive) return Nanoseconds
   is (if Hits (F, Delayed, Node) then F.Late else 0)
   with Global => null;
   --  The delay of the frame behind its end.

   function As_Heard
     (F : Fault; Node : Positive; Frame : Bus_Frames.Bus_Frame)
      return Bus_Frames.Bus_Frame
   with
     Global => null,
     Post   =>
       (if not Hits (F, Corrupted, Node)
        then As_Heard'Result = Frame);
   --  The frame that Node receives for Frame.

end Ravenchart.Can.Bus_Faults;
