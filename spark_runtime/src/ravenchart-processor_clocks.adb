--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Execution_Time;
with Ravenchart.Epochs;

package body Ravenchart.Processor_Clocks
  with SPARK_Mode
is
   use type Ada.Execution_Time.CPU_Time;
   use type Ada.Task_Identification.Task_Id;

   procedure Read (Used : out Nanoseconds) is
      Caller : constant Ada.Task_Identification.Task_Id :=
        Ada.Task_Identification.Current_Task;
      Zero   : constant Ada.Execution_Time.CPU_Time :=
        Ada.Execution_Time.Time_Of (0);
      Now    : Ada.Execution_Time.CPU_Time := Zero;
   begin
      if Caller /= Ada.Task_Identification.Null_Task_Id then
         --  Always true; the contract of the library requires the test.
         Now := Ada.Execution_Time.Clock (Caller);
      end if;
      Used := Epochs.To_Nanoseconds (Now - Zero);
   end Read;

end Ravenchart.Processor_Clocks;
