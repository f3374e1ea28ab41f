--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Xcan_Registers
  with SPARK_Mode
is

   -------------------
   -- Choose_Timing --
   -------------------

   procedure Choose_Timing
     (Clock, Rate : Hertz; T : out Bit_Timing; Found : out Boolean)
   is
      Prescaler : Hertz;
      Count     : Hertz;
   begin
      Bit_Timings.Choose_Quanta
        (Clock, Rate,
         Last_Prescaler => 256,
         Least          => Quanta_Count'First,
         Most           => Quanta_Count'Last,
         Prescaler      => Prescaler,
         Quanta         => Count,
         Found          => Found);
      T :=
        (if Found
         then (Prescaler => Prescaler,
               Segment_1 => Count - 1 - Count / 5,
               Segment_2 => Count / 5)
         else (others => <>));
   end Choose_Timing;

end Ravenchart.Can.Xcan_Registers;
