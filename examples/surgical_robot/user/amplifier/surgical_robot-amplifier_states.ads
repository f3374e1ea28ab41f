--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The driver of an amplifier keeps no state.

package Surgical_Robot.Amplifier_States
with SPARK_Mode
is
   type State is null record;
end Surgical_Robot.Amplifier_States;
