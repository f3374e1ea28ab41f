--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The driver of a tachometer keeps no state.

package Surgical_Robot.Tachometer_States
with SPARK_Mode
is
   type State is null record;
end Surgical_Robot.Tachometer_States;
