--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Gateway between the CAN bus of an emulated ZynqMP and a bench on its host.
--  CAN0 is the controller's. A frame on CAN1 goes to the bench, and a frame of
--  the bench to CAN1.
--
--  Guarantees   frames stay in order; the host takes no time of the board,
--               which stands still while the bench answers
--  Tasking      one task below all others of the controller, which looks
--               every millisecond
--  Timing       outside of the time of the board, except for the look itself
--  Assumptions  ASM-014 and ASM-022: registers, memory and the emulator are as
--               stated here
--
--  At each look the gateway writes lines of slcan and a line feed to the pipe
--  from_board. Then it reads the same from to_board. Both are in the folder
--  where the emulator was started. The byte EOT ends the run.

package Ravenchart.Gateways
  with Elaborate_Body
is
   procedure Start;
   --  Let the gateway begin.

end Ravenchart.Gateways;
