--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Interrupt_Lines
  with SPARK_Mode => Off
is
   protected body Handler is

      entry Wait when Came is
      begin
         Came := False;
      end Wait;

      procedure Handle is
      begin
         Came := True;
      end Handle;

   end Handler;

   procedure Wait (Self : in out Line) is
   begin
      Self.Attached.Wait;
   end Wait;

end Ravenchart.Interrupt_Lines;
