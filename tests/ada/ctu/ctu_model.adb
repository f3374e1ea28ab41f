--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces;

package body Ctu_Model is
   use type Interfaces.Unsigned_32;
   use type Registers.Buffer_State;

   protected body Core is

      procedure Read (From : Registers.Register; Value : out Registers.Word) is
      begin
         Value := 0;
         case From is
            when Registers.Device_Id_Version =>
               Is_Look := False;
               Value   := 16#0202_CAFD#;
            when Registers.Fault_State =>
               Is_Look := True;
               Value   := 2**16;
            when Registers.Tx_Status =>
               for B in Registers.Buffer loop
                  Value :=
                    Value
                    or Interfaces.Shift_Left
                         (Registers.Word (States (B)), 4 * (Natural (B) - 1));
               end loop;
            when others =>
               null;
         end case;
      end Read;

      procedure Write (To : Registers.Register; Value : Registers.Word) is
      begin
         case To is
            when Registers.Tx_Priority =>
               Order := Value;
            when Registers.Tx_Command =>
               for B in Registers.Buffer loop
                  if Value = Registers.Set_Ready (B) then
                     States (B) := Registers.Ready;
                     if not Is_Look then
                        Promptly := Promptly + 1;
                     end if;
                  end if;
               end loop;
            when others =>
               null;
         end case;
      end Write;

      procedure Put
        (Into : Registers.Buffer; I : Ravenchart.Can.Ctu_Frames.Image) is
      begin
         --  A buffer that waits must not be written.
         pragma Assert (States (Into) in 8 | Registers.Sent);
         Ids (Into) := Ravenchart.Can.Ctu_Frames.Id_Of (I);
      end Put;

      procedure Begin_One is
         Best : Registers.Word := 0;
      begin
         for B in reverse Registers.Buffer loop
            if States (B) = Registers.Ready
              and then Registers.Priority_Of (Order, B) >= Best
            then
               Best    := Registers.Priority_Of (Order, B);
               Sending := B;
            end if;
         end loop;
         States (Sending) := Registers.In_Progress;
      end Begin_One;

      procedure End_One (Id : out Ravenchart.Can.Identifier) is
      begin
         States (Sending) := Registers.Sent;
         Id := Ids (Sending);
      end End_One;

      procedure Lose_One is
      begin
         States (Sending) := Registers.Ready;
      end Lose_One;

      function Ready return Natural is
         Result : Natural := 0;
      begin
         for State of States loop
            if State in Registers.Ready | Registers.In_Progress then
               Result := Result + 1;
            end if;
         end loop;
         return Result;
      end Ready;

      function Prompt return Natural
      is (Promptly);

   end Core;

end Ctu_Model;
