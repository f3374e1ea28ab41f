--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Gateway between the CAN bus of an emulated ZynqMP and a bench on its host.
--  CAN0 is the controller's. What comes on CAN1 goes to the bench, and back.
--
--  Guarantees   frames stay in order; nothing of the host gets into the time
--               of the board: it stands still while the bench answers
--  Tasking      one task below all others of the controller, which looks
--               every millisecond
--  Timing       outside of the time of the board, but for the look itself
--  Assumptions  ASM-014 and ASM-022: registers, words and the emulator are as
--               is said here
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
