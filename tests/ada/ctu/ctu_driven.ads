--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A controller with the driver under test.

with System;
with Ravenchart.Can;
with Ravenchart.Can.Controllers;

package Ctu_Driven is

   function Are_All
     (Id : Ravenchart.Can.Identifier; Format : Ravenchart.Can.Frame_Format)
      return Boolean
   is (Ravenchart.Can.Fits (Id, Format));

   package Controller is new Ravenchart.Can.Controllers
     (Transmit_Ceiling => System.Priority'Last,
      Receive_Ceiling  => System.Priority'Last,
      Driver_Priority  => System.Priority'Last - 1,
      Transmit_Depth   => 16,
      Receive_Depth    => 16,
      Stack_Bytes      => 65_536,
      Accepts          => Are_All,
      Setting          => (Bit_Rate => 1_000_000, others => <>));

end Ctu_Driven;
