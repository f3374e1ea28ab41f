--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  ISO-TP: code that is no generic is proved as it is, the object of a
--  reassembly as an instance.

with Ravenchart.Can.Iso_Tp.Reassemblies;
with Ravenchart.Can.Iso_Tp.Receivers;
with Ravenchart.Can.Iso_Tp.Senders;
with System;

package Instance_Iso_Tp
  with SPARK_Mode
is
   package Receivers renames Ravenchart.Can.Iso_Tp.Receivers;
   package Senders renames Ravenchart.Can.Iso_Tp.Senders;

   package Reassembly is new
     Ravenchart.Can.Iso_Tp.Reassemblies
       (Segments =>
          (Length   => 64,
           Block    => 4,
           Timeout  => 1_000_000_000,
           Patience => 1_008_500_000),
        Ceiling  => System.Default_Priority + 1);
end Instance_Iso_Tp;
