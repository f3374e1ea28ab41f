--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Bus_Frames
  with SPARK_Mode
is

   -------------
   -- Time_Of --
   -------------

   function Time_Of (P : Wire.Phases; T : Bit_Times) return Nanoseconds is
      Nominal : constant Nanoseconds := Nanoseconds (P.Nominal) * T.Nominal;
      Data    : constant Nanoseconds := Nanoseconds (P.Data) * T.Data;
   begin
      pragma Assert (Nominal <= Nanoseconds (P.Nominal) * Bit_Time'Last);
      pragma Assert (Data <= Nanoseconds (P.Data) * Bit_Time'Last);
      return Nominal + Data;
   end Time_Of;

end Ravenchart.Can.Bus_Frames;
