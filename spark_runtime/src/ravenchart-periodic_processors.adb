--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Periodic_Loops;

package body Ravenchart.Periodic_Processors
  with SPARK_Mode
is
   procedure Run_All is new Periodic_Loops
     (Name   => Name,
      Cycle  => Cycle,
      Period => Period,
      Offset => Offset,
      Run    => Releases.Run);

   task body Processor is
   begin
      Run_All;
   end Processor;

end Ravenchart.Periodic_Processors;
