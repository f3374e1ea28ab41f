--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The driver of the tracker keeps no state.

package Surgical_Robot.Tracker_States
with SPARK_Mode
is
   type State is null record;
end Surgical_Robot.Tracker_States;
