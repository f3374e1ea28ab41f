--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Authentication of messages: code that is no generic is proved as it is.

with Ravenchart.Can.Authentication;

package Instance_Authentication
  with SPARK_Mode
is
   package Authentication renames Ravenchart.Can.Authentication;
end Instance_Authentication;
