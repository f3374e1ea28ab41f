--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Transmissions
  with SPARK_Mode
is

   ----------
   -- Give --
   ----------

   procedure Give (State : in out Sender) is
   begin
      State.Has_Value := True;
      State.Is_Asked  := True;
   end Give;

   -----------
   -- Count --
   -----------

   procedure Count (State : in out Sender) is
   begin
      if State.Since < Execution_Count'Last then
         State.Since := State.Since + 1;
      end if;
   end Count;

   -----------------
   -- Record_Sent --
   -----------------

   procedure Record_Sent (State : in out Sender; F : Any_Frames.Any_Frame) is
   begin
      State := (State.Has_Value, False, True, F, 0);
   end Record_Sent;

end Ravenchart.Can.Transmissions;
