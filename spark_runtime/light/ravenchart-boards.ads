--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The services of a board for a controller beside its run-time library: the
--  one unit of a port that each board has a body of.
--
--  Guarantees   nothing here needs the heap, the secondary stack or an
--               exception
--  Tasking      any task may call; Finish may be called within the last-chance
--               handler
--  Timing       Put waits for the serial line; the rest is constant
--  Assumptions  ASM-014, the body does what this specification states

package Ravenchart.Boards
  with Elaborate_Body
is
   procedure Put (Text : String);
   --  Write Text on the serial line of the report.

   function Run_Time return Nanoseconds;
   --  The time from Epochs.Start until the controller shall end; the last
   --  value where its run does not end.

   procedure Feed_Watchdog;
   --  Restart the time-out of the board's watchdog.

   procedure Finish (Success : Boolean)
   with No_Return;
   --  The controller has ended.

end Ravenchart.Boards;
