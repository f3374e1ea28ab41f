--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Boards;

package body Ravenchart.Hosts.Services
  with SPARK_Mode => Off
--  ASM-002. The serial line and the end of a run are matters of the board.
is

   procedure Start is null;
   --  The serial line is ready from the start of the board.

   --------------------
   -- Stop_Requested --
   --------------------

   function Stop_Requested return Boolean is
      Now : Nanoseconds;
   begin
      Epochs.Since_Start (Now);
      return Now >= Boards.Run_Time;
   end Stop_Requested;

   ---------
   -- Put --
   ---------

   procedure Put (Text : String) is
   begin
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
