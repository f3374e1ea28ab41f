--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One representative instance of the releases by interrupts, and their source.

with Ravenchart.Interrupt_Releases;
with Ravenchart.Interrupt_Sources;

package Instance_Interrupts
  with SPARK_Mode
is
   package Releases is new Ravenchart.Interrupt_Releases
     (Separation => 2_000_000);

   package Source is new Ravenchart.Interrupt_Sources
     (Signal => 10,
      Number => 1,
      Arrive => Releases.Arrive);

end Instance_Interrupts;
