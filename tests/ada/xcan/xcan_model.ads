--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A CAN controller of Zynq as the driver sees it, without a bus: frames that
--  are sent are kept, and the test sets the frames that come and the state.

with System;
with Ravenchart.Can;
with Ravenchart.Can.Xcan_Frames;
with Ravenchart.Can.Xcan_Registers;

package Xcan_Model is

   subtype Place is Natural range 0 .. 64;

   type Frame_List is array (Place range 1 .. 64)
     of Ravenchart.Can.Xcan_Frames.Image;

   protected Controller
     with Priority => System.Priority'Last
   is
      procedure Read
        (From  : Ravenchart.Can.Xcan_Registers.Register;
         Value : out Ravenchart.Can.Xcan_Registers.Word);

      procedure Write
        (To    : Ravenchart.Can.Xcan_Registers.Register;
         Value : Ravenchart.Can.Xcan_Registers.Word);

      procedure Take (I : out Ravenchart.Can.Xcan_Frames.Image);

      procedure Put (I : Ravenchart.Can.Xcan_Frames.Image);

      --  For the test

      procedure Arrive (F : Ravenchart.Can.Frame);
      --  A frame comes, if there is room.

      procedure Stand (As : Ravenchart.Can.Controller_State);
      --  Set the state: error-passive, bus-off, or error-active again. While
      --  it is bus-off no frame is sent.

      procedure Block (Sending : Boolean);
      --  Block or release the sending: other nodes have the bus.

      function Sent return Natural;

      function Is_In_Reset return Boolean;

      function Resets return Natural;

   private
      State    : Ravenchart.Can.Controller_State :=
        Ravenchart.Can.Error_Active;
      In_Reset : Boolean := True;
      Overflow : Boolean := False;
      Blocked  : Boolean := False;
      Waiting  : Frame_List;
      Count    : Place := 0;
      Pending  : Natural := 0;
      Gone     : Natural := 0;
      Times    : Natural := 0;
   end Controller;

end Xcan_Model;
