--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with System;
with Ravenchart.Interrupt_Lines;

package body Ravenchart.Interrupt_Sources
  with SPARK_Mode
is
   package Taking
     with SPARK_Mode => Off
   --  ASM-024. The line is the target's: SPARK does not follow an interrupt.
   is
      Line : Interrupt_Lines.Line (Signal, Number);

      task Source
      with
        Interrupt_Priority => System.Interrupt_Priority'First,
        Storage_Size       => 16_384;
      --  Never ends.
   end Taking;

   procedure Take
   with SPARK_Mode => Off  --  ASM-024
   is
   begin
      Interrupt_Lines.Wait (Taking.Line);
      Arrive;
   end Take;

   package body Taking
     with SPARK_Mode => Off
   is
      task body Source is
      begin
         loop
            Take;
         end loop;
      end Source;

   begin
      Interrupt_Lines.Open (Line);
   end Taking;

end Ravenchart.Interrupt_Sources;
