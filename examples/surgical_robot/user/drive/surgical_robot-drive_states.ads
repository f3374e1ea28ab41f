--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The driver of the drives keeps no state: they have a servo loop.

package Surgical_Robot.Drive_States
with SPARK_Mode
is
   type State is null record;
end Surgical_Robot.Drive_States;
