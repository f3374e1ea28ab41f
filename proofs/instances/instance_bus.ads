--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A CAN controller, with the driver that the project selects.

with System;
with Ravenchart.Can;
with Ravenchart.Can.Controllers;

package Instance_Bus
  with SPARK_Mode
is
   function Accepts
     (Id : Ravenchart.Can.Identifier; Format : Ravenchart.Can.Frame_Format)
      return Boolean
   is (Ravenchart.Can."=" (Format, Ravenchart.Can.Standard)
       and then Id in 16#100# .. 16#10F#)
   with Global => null;
   --  The acceptance filter.

   package Controller is new Ravenchart.Can.Controllers
     (Transmit_Ceiling => System.Default_Priority + 6,
      Receive_Ceiling  => System.Default_Priority + 6,
      Driver_Priority  => System.Default_Priority + 6,
      Transmit_Depth   => 8,
      Receive_Depth    => 8,
      Stack_Bytes      => 65_536,
      Accepts          => Accepts,
      Setting          =>
        (Bit_Rate  => 500_000,
         Data_Rate => 2_000_000,
         Takes_Fd  => True,
         Recovery  => Ravenchart.Can.On_Request));

end Instance_Bus;
