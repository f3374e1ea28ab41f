--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Flexible_Feature.Gauge.Activities
with SPARK_Mode
is
   procedure Tell
     (Posture : Gauge.Posture_View;
      Motion  : Gauge.Motion_View;
      Status  : Gauge.Status_View;
      Gear    : Gauge.Gear_View;
      Bent    : out Flexible_Feature.Posture;
      Moved   : out Flexible_Feature.Motion;
      Shown   : out Flexible_Feature.Status;
      Geared  : out Flexible_Feature.Short;
      Plain   : out Flexible_Feature.Short) is
   begin
      Bent := Posture.Value;
      Moved := Motion.Value;
      Shown := Status.Value;
      Geared := Gear.Value;
      Plain := Gear.Value;
   end Tell;
end Flexible_Feature.Gauge.Activities;
