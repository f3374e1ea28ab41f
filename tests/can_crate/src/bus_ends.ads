--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A CAN controller with the driver of this build.

with System;
with Ravenchart.Can;
with Ravenchart.Can.Controllers;

package Bus_Ends
  with SPARK_Mode
is
   use type Ravenchart.Can.Frame_Format;
   use type Ravenchart.Can.Identifier;

   function Accepts
     (Id     : Ravenchart.Can.Identifier;
      Format : Ravenchart.Can.Frame_Format) return Boolean
   is (Format = Ravenchart.Can.Standard and then Id >= 16#100#);

   package Controller is new Ravenchart.Can.Controllers
     (Transmit_Ceiling => System.Default_Priority + 8,
      Receive_Ceiling  => System.Default_Priority + 8,
      Driver_Priority  => System.Default_Priority + 6,
      Transmit_Depth   => 8,
      Receive_Depth    => 8,
      Stack_Bytes      => 65_536,
      Accepts          => Accepts,
      Setting          => (Bit_Rate => 500_000, others => <>));

end Bus_Ends;
