--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Fault_Confinement
  with SPARK_Mode
is

   -----------
   -- Count --
   -----------

   procedure Count (N : in out Node; Event : Fault_Event) is
   begin
      N :=
        (Transmit => Transmit_Rule (Event, State (N), N.Transmit),
         Receive  => Receive_Rule (Event, N.Receive),
         Left     => Whole_Recovery);
   end Count;

   -------------
   -- Monitor --
   -------------

   procedure Monitor (N : in out Node; Bus : Levels.Level) is
   begin
      if Bus = Levels.Dominant then
         N.Left := Sequence_Restarted (N.Left);
      elsif N.Left > 1 then
         N.Left := N.Left - 1;
      else
         N := (others => <>);
      end if;
   end Monitor;

end Ravenchart.Can.Fault_Confinement;
