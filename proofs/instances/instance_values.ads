--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Provers see only instances: one of the buffer of recorded values. The unit
--  that writes its values out is proved with the runtime.

with System;
with Ravenchart.Value_Buffers;

package Instance_Values
  with SPARK_Mode
is
   Ceiling : constant System.Priority := System.Default_Priority + 7;

   package Values is new Ravenchart.Value_Buffers
     (Capacity => 64, Ceiling => Ceiling);

end Instance_Values;
