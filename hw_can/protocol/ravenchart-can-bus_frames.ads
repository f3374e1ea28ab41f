--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The frames that a node of the simulated bus hands to its controller, and
--  their durations on the wire.
--
--  Guarantees   a duration follows from the bits of the frame's image alone
--  Tasking      none: frames are values
--  Timing       linear in the length of a frame

with Ravenchart.Can.Arbitration;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Wire;

package Ravenchart.Can.Bus_Frames
  with SPARK_Mode, Pure
is
   use type Arbitration.Contender;
   use type Fd_Frames.Bit_Rate_Use;
   use type Wire.Phases;

   type Bus_Frame_Family is (Classic, Flexible, Asked_Error);
   --  CAN 2.0, CAN FD, or a request to the bus for an error frame. Such a
   --  request has the class and the details of the error frame as a frame.

   type Bus_Frame (Family : Bus_Frame_Family := Classic) is record
      case Family is
         when Classic | Asked_Error =>
            Plain : Frame;
         when Flexible              =>
            Fd : Fd_Frames.Fd_Frame;
      end case;
   end record;

   function Contender_Of (F : Bus_Frame) return Arbitration.Contender
   is (if F.Family = Flexible
       then (Id => F.Fd.Id, Format => F.Fd.Format, Kind => Data)
       else (Id     => F.Plain.Id,
             Format => F.Plain.Format,
             Kind   => F.Plain.Kind))
   with Global => null;
   --  The part of F in arbitration.

   function Is_First (A, B : Bus_Frame) return Boolean
   is (A.Family = Asked_Error
       or else
         (B.Family /= Asked_Error
          and then
            (Contender_Of (A) = Contender_Of (B)
             or else
               Arbitration.Precedes (Contender_Of (A), Contender_Of (B)))))
   with Global => null;
   --  May A be on the bus when B was offered too? The flag of an error frame
   --  overrules every frame.

   function Image_Of (F : Bus_Frame) return Wire.Image
   is (if F.Family = Flexible
       then Wire.To_Wire (F.Fd)
       else Wire.To_Wire (F.Plain))
   with
     Global => null,
     Post   => Wire.Is_Ordered (Image_Of'Result);
   --  The bits on the bus; for a requested error frame, those of the frame
   --  that names it.

   function Rate_Of (F : Bus_Frame) return Fd_Frames.Bit_Rate_Use
   is (if F.Family = Flexible then F.Fd.Rate else Fd_Frames.Constant_Rate)
   with Global => null;
   --  Does its data phase go at the data bit rate?

   subtype Bit_Time is Positive_Nanoseconds range 1 .. 10**9;
   --  One bit, in ns: 1 bit/s at the least.

   type Bit_Times is record
      Nominal : Bit_Time := 2_000;
      Data    : Bit_Time := 500;
      Switch  : Nanoseconds range 0 .. Bit_Time'Last := 1_200;
   end record;
   --  By default 500 kbit/s, and 2 Mbit/s in the data phase. Switch: how much
   --  later the sample point of a nominal bit lies in its bit than that of a
   --  data bit in its own; here both are at 80 %.

   Longest_Time : constant Positive_Nanoseconds :=
     Wire.Longest * Bit_Time'Last;
   --  No phase of a frame takes longer.

   function Least
     (A, B : Wire.Bit_Count) return Wire.Bit_Count
   is (if A < B then A else B)
   with Global => null;
   --  The lesser of two.

   function Phases_Until
     (I    : Wire.Image;
      Rate : Fd_Frames.Bit_Rate_Use;
      Last : Wire.Bit_Count) return Wire.Phases
   is (if Rate = Fd_Frames.Constant_Rate
         or else Last < I.Ends (Wire.Format_Bits)
       then (Nominal => Last, Data => 0)
       else
         (Nominal =>
            I.Ends (Wire.Format_Bits) - 1
            + (Last - Least (Last, I.Ends (Wire.Check_Field))),
          Data    =>
            Least (Last, I.Ends (Wire.Check_Field))
            - I.Ends (Wire.Format_Bits) + 1))
   with
     Global => null,
     Pre    => Wire.Is_Ordered (I),
     Post   =>
       Phases_Until'Result.Nominal + Phases_Until'Result.Data = Last
       and then
         (if Last = Wire.Length (I)
          then Phases_Until'Result = Wire.Phases_Of (I, Rate));
   --  The bits up to Last, by their rate: the bit of the switch counts as a
   --  data bit, the delimiter of the CRC as a nominal one.

   function Time_Of (P : Wire.Phases; T : Bit_Times) return Nanoseconds
   with
     Global => null,
     Post   =>
       Time_Of'Result =
         Nanoseconds (P.Nominal) * T.Nominal
         + Nanoseconds (P.Data) * T.Data
       and then Time_Of'Result <= 2 * Longest_Time;
   --  The duration of so many bits.

   function Time_Until
     (I    : Wire.Image;
      Rate : Fd_Frames.Bit_Rate_Use;
      Last : Wire.Bit_Count;
      T    : Bit_Times) return Nanoseconds
   is (Time_Of (Phases_Until (I, Rate, Last), T)
       + (if Rate = Fd_Frames.Switched_Rate
            and then Last in I.Ends (Wire.Format_Bits)
                             .. I.Ends (Wire.Check_Field)
          then T.Switch else 0))
   with
     Global => null,
     Pre    => Wire.Is_Ordered (I),
     Post   => Time_Until'Result <= 2 * Longest_Time + Bit_Time'Last;
   --  The time from the start of frame to the end of bit Last. The bit of the
   --  switch is nominal up to its sample point, the delimiter of the CRC
   --  behind it: so bits between them end later by Switch.

end Ravenchart.Can.Bus_Frames;
