--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The object of a reassembly, outside any stack: values of 19 bytes,
--  requested segment by segment.

with Ravenchart.Can.Iso_Tp.Reassemblies;
with System;

package Reassembled is new
  Ravenchart.Can.Iso_Tp.Reassemblies
    (Segments =>
       (Length   => 19,
        Block    => 1,
        Timeout  => 3_000_000,
        Patience => 4_000_000),
     Ceiling  => System.Priority'Last);
