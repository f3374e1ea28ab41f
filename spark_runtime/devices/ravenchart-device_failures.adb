--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Failures;

package body Ravenchart.Device_Failures
  with SPARK_Mode => Off
is

   ----------
   -- Note --
   ----------

   procedure Note (Device : String) is
   begin
      Failures.Put_Error
        ("error: the device " & Device
         & " has failed its initialisation or self-test: the controller does"
         & " not start");
   end Note;

   ---------------
   -- Note_Late --
   ---------------

   procedure Note_Late is
   begin
      Failures.Put_Error
        ("error: the devices were not ready by the first release: the"
         & " controller does not start");
   end Note_Late;

end Ravenchart.Device_Failures;
