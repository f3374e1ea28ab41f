--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The core of the one controller: CAN0 of Zynq UltraScale+ (UG1085). That of
--  Zynq-7000 is at 16#E000_8000#.

pragma SPARK_Mode;

with Ravenchart.Can.Xcan_Cores;

package Ravenchart.Can.Xcan_Core is new Ravenchart.Can.Xcan_Cores
  (Base => 16#FF06_0000#);
