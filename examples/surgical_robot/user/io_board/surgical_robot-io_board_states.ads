--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The driver of an I/O board keeps no state: all of it is in the registers.

package Surgical_Robot.Io_Board_States
with SPARK_Mode
is
   type State is null record;
end Surgical_Robot.Io_Board_States;
