--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces;

package body Ravenchart.Can.Transmit_Orders
  with SPARK_Mode, Refined_State => (State => Chosen)
is
   use type Interfaces.Unsigned_8;

   Chosen : Interfaces.Unsigned_8 := 0
   with Atomic, Async_Readers, Async_Writers;
   --  A bit for each bus, the lowest for bus 1: by priority.

   function Bit (Bus : Bus_Place) return Interfaces.Unsigned_8
   is (Interfaces.Shift_Left (1, Bus - 1))
   with Global => null;

   ---------------------
   -- Set_By_Priority --
   ---------------------

   procedure Set_By_Priority (Bus : Bus_Place) is
      Before : constant Interfaces.Unsigned_8 := Chosen;
   begin
      Chosen := Before or Bit (Bus);
   end Set_By_Priority;

   ----------
   -- Read --
   ----------

   procedure Read (Bus : Bus_Place; By_Priority : out Boolean) is
      Now : constant Interfaces.Unsigned_8 := Chosen;
   begin
      By_Priority := (Now and Bit (Bus)) /= 0;
   end Read;

end Ravenchart.Can.Transmit_Orders;
