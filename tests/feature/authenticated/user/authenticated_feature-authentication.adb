--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Aes_Cmac;

package body Authenticated_Feature.Authentication
  with SPARK_Mode
is
   use Ravenchart.Can.Authentication;

   type Secrets is array (Keys) of Tag_Bytes;

   Secret : constant Secrets :=
     (Key_Valve =>
        (16#2B#, 16#7E#, 16#15#, 16#16#, 16#28#, 16#AE#, 16#D2#, 16#A6#,
         16#AB#, 16#F7#, 16#15#, 16#88#, 16#09#, 16#CF#, 16#4F#, 16#3C#),
      Key_Pump  =>
        (16#60#, 16#3D#, 16#EB#, 16#10#, 16#15#, 16#CA#, 16#71#, 16#BE#,
         16#2B#, 16#73#, 16#AE#, 16#F0#, 16#85#, 16#7D#, 16#77#, 16#81#));
   --  Keys of a test stand in its sources; those of a product do not.

   ---------
   -- Mac --
   ---------

   function Mac (Key : Keys; Item : Mac_Input) return Mac_Answer
   is (Aes_Cmac.Cmac (Secret (Key), Item));

   --------------------
   -- Last_Freshness --
   --------------------

   function Last_Freshness (Message : Messages) return Freshness_Value
   is (case Message is
         when Message_Third_In  => 16#1_FFFF_FFFD#,
         when Message_Third_Out => 16#2_FFFF_FFFA#,
         when others            => 0);
   --  The third ones have come so far in an earlier run.

end Authenticated_Feature.Authentication;
