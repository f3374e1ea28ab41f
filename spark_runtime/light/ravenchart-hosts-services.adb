--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Boards;
with System;

package body Ravenchart.Hosts.Services
  with SPARK_Mode => Off
--  ASM-002. The serial line and the end of a run depend on the board.
is
   use type System.Address;

   procedure Put_All
   with Import, External_Name => "ravenchart_put_all";
   pragma Weak_External (Put_All);
   --  Reports.Put_All of a generated program, linked by this name. In other
   --  programs its address is null.

   Model        : String (1 .. 84) := (others => ' ');
   Model_Length : Natural := 0;
   --  The M line: M, a digest of at most 80 characters, and its end.

   Report_Period : constant Nanoseconds := 1_000_000_000;

   Next_Report : Nanoseconds := Report_Period;
   --  The time of the next M line, with the statistics behind it. A reader
   --  that connects to the serial line of a running board learns its model
   --  from it.

   procedure Start is null;
   --  The serial line is ready from the start of the board.

   --------------------
   -- Stop_Requested --
   --------------------

   function Stop_Requested return Boolean is
      Now : Nanoseconds;
   begin
      Epochs.Since_Start (Now);
      if Now >= Next_Report then
         Next_Report := Now + Report_Period;
         Boards.Put (Model (1 .. Model_Length));
         if Put_All'Address /= System.Null_Address then
            Put_All;
         end if;
      end if;
      return Now >= Boards.Run_Time;
   end Stop_Requested;

   ---------
   -- Put --
   ---------

   procedure Put (Text : String) is
   begin
      if Text (Text'First) = 'M' and then Text'Length <= Model'Length then
         Model (1 .. Text'Length) := Text;
         Model_Length := Text'Length;
      end if;
      Boards.Put (Text);
   end Put;

   procedure Flush is null;
   --  Each line is written at once.

   ------------
   -- Finish --
   ------------

   procedure Finish (Success : Boolean) is
   begin
      Boards.Finish (Success);
   end Finish;

end Ravenchart.Hosts.Services;
