--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What the driver remembers of a drive: where its axis was calibrated to, and
--  whether its limit was told.

package Registers_Feature.Drive_States
with SPARK_Mode
is
   type State is record
      Zero     : Angle   := 0;
      At_Limit : Boolean := False;
   end record;
end Registers_Feature.Drive_States;
