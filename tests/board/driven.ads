--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A controller with the driver under test, and a task that takes what comes.

with System;
with Ravenchart.Can;
with Ravenchart.Can.Controllers;

package Driven is
   use type Ravenchart.Can.Identifier;

   function Are_Low
     (Id : Ravenchart.Can.Identifier; Format : Ravenchart.Can.Frame_Format)
      return Boolean
   is (Ravenchart.Can.Fits (Id, Format) and then Id < 1_000);

   package Controller is new Ravenchart.Can.Controllers
     (Transmit_Ceiling => System.Priority'Last,
      Receive_Ceiling  => System.Priority'Last,
      Driver_Priority  => System.Priority'Last - 1,
      Transmit_Depth   => 64,
      Receive_Depth    => 128,
      Stack_Bytes      => 65_536,
      Accepts          => Are_Low,
      Setting          => (Bit_Rate => 500_000, others => <>));

   protected Taken
     with Priority => System.Priority'Last
   is
      procedure Note (Id : Ravenchart.Can.Identifier);

      function Count return Natural;

      function In_Order return Boolean;
      --  Has each one come behind the one with the identifier before?

   private
      Seen  : Natural := 0;
      Last  : Ravenchart.Can.Identifier := 0;
      Right : Boolean := True;
   end Taken;

private

   task Taker
   with Priority => System.Default_Priority, Storage_Size => 65_536;

end Driven;
