--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  End-to-end protection: code that is no generic is proved as it is.

with Ravenchart.Can.Data_Crcs;
with Ravenchart.Can.Protection;

package Instance_Protection
  with SPARK_Mode
is
   package Data_Crcs renames Ravenchart.Can.Data_Crcs;
   package Protection renames Ravenchart.Can.Protection;
end Instance_Protection;
