--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The transmit buffers of a CTU CAN FD core as the driver sees them. The test
--  is the bus: it begins each transmission, and ends it.

with System;
with Ravenchart.Can;
with Ravenchart.Can.Ctu_Frames;
with Ravenchart.Can.Ctu_Registers;

package Ctu_Model is

   package Registers renames Ravenchart.Can.Ctu_Registers;

   type State_List is array (Registers.Buffer) of Registers.Buffer_State;

   type Id_List is array (Registers.Buffer) of Ravenchart.Can.Identifier;

   protected Core
     with Priority => System.Priority'Last
   is
      procedure Read (From : Registers.Register; Value : out Registers.Word);

      procedure Write (To : Registers.Register; Value : Registers.Word);

      procedure Put
        (Into : Registers.Buffer; I : Ravenchart.Can.Ctu_Frames.Image);

      --  For the test

      procedure Begin_One;
      --  The core begins to send the ready buffer of the highest priority, of
      --  equal ones the first.

      procedure End_One (Id : out Ravenchart.Can.Identifier);
      --  That frame has been sent.

      procedure Lose_One;
      --  That frame has lost arbitration: its buffer is ready again.

      function Ready return Natural;
      --  Buffers that are ready or being sent.

      function Prompt return Natural;
      --  Buffers that became ready apart from a look at the state.

   private
      States   : State_List := (others => 8);
      Ids      : Id_List := (others => 0);
      Order    : Registers.Word := 16#1111#;
      Sending  : Registers.Buffer := 1;
      Is_Look  : Boolean := False;
      Promptly : Natural := 0;
   end Core;

end Ctu_Model;
