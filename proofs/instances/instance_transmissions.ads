--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Transmission modes: code that is no generic is proved as it is.

with Ravenchart.Can.Transmissions;

package Instance_Transmissions
  with SPARK_Mode
is
   package Transmissions renames Ravenchart.Can.Transmissions;
end Instance_Transmissions;
