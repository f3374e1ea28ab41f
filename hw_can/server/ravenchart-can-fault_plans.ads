--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The frames of a run and their faults: from a list, or by chance from a
--  seed, so that the same run can be repeated.
--
--  Guarantees   each fault of the list occurs once, with the frame that it
--               names; two random faults are never closer than the separation
--  Tasking      none: one owner for each Plan
--  Timing       linear in the list

with Interfaces;
with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Wire;

package Ravenchart.Can.Fault_Plans
  with SPARK_Mode, Pure
is
   use type Bus_Faults.Fault;
   use type Bus_Faults.Fault_Kind;
   use type Interfaces.Unsigned_32;

   type Planned is record
      Frame : Event_Count := 0;
      Fault : Bus_Faults.Fault;
   end record;
   --  The number of a frame, from 1; all frames that began count, also those
   --  with errors.

   subtype Plan_Count is Natural range 0 .. 64;

   subtype Plan_Index is Plan_Count range 1 .. 64;

   type Planned_List is array (Plan_Index) of Planned;

   type Plan is record
      Listed     : Planned_List;
      Count      : Plan_Count := 0;
      Frames     : Event_Count := 0;
      Seed       : Interfaces.Unsigned_32 := 0;
      Separation : Nanoseconds := 0;
      Not_Before : Nanoseconds := 0;
   end record;
   --  With a Separation above 0, a frame that begins at Not_Before or later
   --  has a disturbed bit, at a position that Seed selects.

   function Next (Seed : Interfaces.Unsigned_32)
     return Interfaces.Unsigned_32
   is (Seed * 1_664_525 + 1_013_904_223)
   with Global => null;
   --  The sequence of Knuth and Lewis, for its upper bits.

   function Drawn_Position (Seed : Interfaces.Unsigned_32)
     return Wire.Bit_Index
   is (1 + Natural (Interfaces.Shift_Right (Seed, 16) mod 160))
   with Global => null;
   --  The position of the random bit: anywhere in a classic frame.

   function Is_Listed (P : Plan; Frame : Event_Count) return Boolean
   is (for some I in 1 .. P.Count => P.Listed (I).Frame = Frame)
   with Global => null;
   --  Does the list name this frame?

   procedure Draw
     (P : in out Plan; Now : Nanoseconds; Fault : out Bus_Faults.Fault)
   with
     Global => null,
     Post   =>
       P.Count = P.Count'Old
       and then P.Frames = Next (P.Frames'Old)
       and then P.Separation = P.Separation'Old
       and then P.Not_Before = P.Not_Before'Old
       and then
         (if Is_Listed (P, P.Frames)
          then
            (for some I in 1 .. P.Count =>
               P.Listed (I).Frame = P.Frames
               and then P.Listed (I).Fault = Fault)
          elsif Fault.Kind /= Bus_Faults.None
          then P.Separation > 0
            and then Now >= P.Not_Before
            and then Fault.Kind = Bus_Faults.Disturbed_Bit);
   --  The fault of the frame that begins Now.

   procedure Note (P : in out Plan; Struck : Nanoseconds)
   with
     Global => null,
     Post   =>
       (if Struck <= Nanoseconds'Last - P.Separation
        then P.Not_Before = Struck + P.Separation
        else P.Not_Before = Nanoseconds'Last);
   --  An error occurred at Struck: no random fault until the separation is
   --  over.

end Ravenchart.Can.Fault_Plans;
