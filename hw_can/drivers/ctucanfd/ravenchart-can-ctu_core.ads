--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The core of the one controller.

pragma SPARK_Mode;

with Ravenchart.Can.Ctu_Cores;

package Ravenchart.Can.Ctu_Core is new Ravenchart.Can.Ctu_Cores (Behind => 0);
