--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package Forwarded_Feature.Drive_States
with SPARK_Mode
is
   type Call_Count is mod 2 ** 32;

   type State is record
      Calls : Call_Count := 0;
      Place : Forwarded_Feature.Place := 0;
   end record;
end Forwarded_Feature.Drive_States;
