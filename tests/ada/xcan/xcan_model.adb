--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces;

package body Xcan_Model is
   use type Interfaces.Unsigned_32;
   use type Ravenchart.Can.Controller_State;

   package Registers renames Ravenchart.Can.Xcan_Registers;

   protected body Controller is

      procedure Send_All;

      procedure Send_All is
      begin
         if not In_Reset
           and then not Blocked
           and then State /= Ravenchart.Can.Bus_Off
         then
            Gone    := Gone + Pending;
            Pending := 0;
         end if;
      end Send_All;

      procedure Read
        (From : Registers.Register; Value : out Registers.Word) is
      begin
         Send_All;
         case From is
            when Registers.Sr =>
               Value :=
                 (if In_Reset then 1
                  else
                    (case State is
                       when Ravenchart.Can.Bus_Off       => 2 * 2**7,
                       when Ravenchart.Can.Error_Passive => 3 * 2**7,
                       when others                       => 2**7));
            when Registers.Ecr =>
               Value :=
                 (if State = Ravenchart.Can.Error_Active then 0 else 16#80#);
            when Registers.Isr =>
               Value :=
                 (if Count > 0 then Registers.Receive_Not_Empty else 0)
                 or (if Overflow then Registers.Receive_Overflow else 0)
                 or (if Pending = 0 then Registers.Transmit_Empty else 0);
            when others =>
               Value := 0;
         end case;
      end Read;

      procedure Write (To : Registers.Register; Value : Registers.Word) is
      begin
         case To is
            when Registers.Srr =>
               In_Reset := (Value and Registers.Reset) /= 0;
               if In_Reset then
                  Times    := Times + 1;
                  State    := Ravenchart.Can.Error_Active;
                  Count    := 0;
                  Pending  := 0;
                  Overflow := False;
               end if;
            when Registers.Icr =>
               if (Value and Registers.Receive_Overflow) /= 0 then
                  Overflow := False;
               end if;
            when others =>
               null;
         end case;
      end Write;

      procedure Take (I : out Ravenchart.Can.Xcan_Frames.Image) is
      begin
         I := Waiting (1);
         Waiting (1 .. Count - 1) := Waiting (2 .. Count);
         Count := Count - 1;
      end Take;

      procedure Put (I : Ravenchart.Can.Xcan_Frames.Image) is
         pragma Unreferenced (I);
      begin
         Pending := Pending + 1;
      end Put;

      procedure Arrive (F : Ravenchart.Can.Frame) is
      begin
         if Count = Place'Last then
            Overflow := True;
         else
            Count := Count + 1;
            Waiting (Count) := Ravenchart.Can.Xcan_Frames.Image_Of (F);
         end if;
      end Arrive;

      procedure Stand (As : Ravenchart.Can.Controller_State) is
      begin
         State := As;
      end Stand;

      procedure Block (Sending : Boolean) is
      begin
         Blocked := Sending;
      end Block;

      function Sent return Natural
      is (Gone);

      function Is_In_Reset return Boolean
      is (In_Reset);

      function Resets return Natural
      is (Times);

   end Controller;

end Xcan_Model;
