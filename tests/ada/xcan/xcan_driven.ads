--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A controller with the driver under test, which leaves bus-off on request.

with System;
with Ravenchart.Can;
with Ravenchart.Can.Controllers;

package Xcan_Driven is
   use type Ravenchart.Can.Identifier;

   function Are_Low
     (Id : Ravenchart.Can.Identifier; Format : Ravenchart.Can.Frame_Format)
      return Boolean
   is (Ravenchart.Can.Fits (Id, Format) and then Id < 1_000);

   package Controller is new Ravenchart.Can.Controllers
     (Transmit_Ceiling => System.Priority'Last,
      Receive_Ceiling  => System.Priority'Last,
      Driver_Priority  => System.Priority'Last - 1,
      Transmit_Depth   => 16,
      Receive_Depth    => 128,
      Stack_Bytes      => 65_536,
      Accepts          => Are_Low,
      Setting          =>
        (Bit_Rate => 1_000_000,
         Recovery => Ravenchart.Can.On_Request,
         others   => <>));

end Xcan_Driven;
