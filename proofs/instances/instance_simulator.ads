--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The core of the bus simulator: code that is no generic is proved as it is.

with Ravenchart.Can.Arbitration;
with Ravenchart.Can.Error_Frames;
with Ravenchart.Can.Fault_Confinement;
with Ravenchart.Can.Fd_Frames;
with Ravenchart.Can.Wire;

package Instance_Simulator
  with SPARK_Mode
is
   package Arbitration renames Ravenchart.Can.Arbitration;
   package Error_Frames renames Ravenchart.Can.Error_Frames;
   package Fault_Confinement renames Ravenchart.Can.Fault_Confinement;
   package Fd_Frames renames Ravenchart.Can.Fd_Frames;
   package Wire renames Ravenchart.Can.Wire;
end Instance_Simulator;
