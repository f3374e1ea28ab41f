--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Sporadic_Loops;

package body Ravenchart.Sporadic_Processors
  with SPARK_Mode
is
   procedure Run_All is new Sporadic_Loops
     (Name               => Name,
      Minimum_Separation => Minimum_Separation,
      Wait               => Wait,
      Start_Release      => Releases.Start_Release,
      Run                => Releases.Run);

   task body Processor is
   begin
      Run_All;
   end Processor;

end Ravenchart.Sporadic_Processors;
