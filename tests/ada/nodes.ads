--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The CAN controller under test, with the driver of this build.

with Ada.Environment_Variables;
with System;
with Ravenchart;
with Ravenchart.Can;
with Ravenchart.Can.Controllers;

package Nodes is

   function Accepts
     (Id : Ravenchart.Can.Identifier; Format : Ravenchart.Can.Frame_Format)
      return Boolean;
   --  Accepts all but the extended identifiers below 16#100#.

   package Node is new Ravenchart.Can.Controllers
     (Transmit_Ceiling => System.Default_Priority + 8,
      Receive_Ceiling  => System.Default_Priority + 8,
      Driver_Priority  => System.Default_Priority + 6,
      Transmit_Depth   => 1_000,
      Receive_Depth    => 100,
      Stack_Bytes      => 65_536,
      Accepts          => Accepts,
      Setting          =>
        (Bit_Rate  => 500_000,
         Data_Rate => 2_000_000,
         Takes_Fd  =>
           not Ada.Environment_Variables.Exists ("CAN_ECHO_CLASSIC"),
         Recovery  =>
           (if Ada.Environment_Variables.Exists ("CAN_ECHO_ON_REQUEST")
            then Ravenchart.Can.On_Request
            else Ravenchart.Can.Automatic)));

   procedure Send
     (F : Ravenchart.Can.Frame; Status : out Ravenchart.Can.Send_Status);
   --  Send a classic frame.

   procedure Wait_Frame
     (F : out Ravenchart.Can.Frame; Stamp : out Ravenchart.Nanoseconds);
   --  Wait for a classic frame; Null_Frame where it is none.

end Nodes;
