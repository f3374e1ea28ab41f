--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Fault_Notices
  with SPARK_Mode
is
   ---------------------------
   -- Lemma_No_Fault_Missed --
   ---------------------------

   procedure Lemma_No_Fault_Missed
     (Seen, Log : Fault_Log; Now : Controller_State)
   is null;

   ---------------
   -- Count_Off --
   ---------------

   procedure Count_Off
     (Left   : in out Look_Count;
      Found  : Notices;
      State  : Controller_State;
      Limit  : Look_Count;
      Is_Due : out Boolean)
   is
      Goes_On : constant Boolean :=
        State = Can.Bus_Off and then not Found.Bus_Off;
   begin
      Is_Due := Goes_On and then Left = 1;
      Left   := (if Goes_On and then Left > 1 then Left - 1 else Limit);
   end Count_Off;

end Ravenchart.Can.Fault_Notices;
