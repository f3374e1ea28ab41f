--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One representative instance of the releases by interrupts.

with Ravenchart.Interrupt_Releases;

package Instance_Interrupts
  with SPARK_Mode
is
   package Releases is new Ravenchart.Interrupt_Releases
     (Separation => 2_000_000);

end Instance_Interrupts;
