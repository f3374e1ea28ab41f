--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Interfaces.C;
with Ravenchart.Can.Linux_Calls;

package body Ravenchart.Can.Serial_Lines
  with SPARK_Mode => Off
--  ASM-005. Lines are reached through the C library, by address.
is
   use type Interfaces.C.int;
   use type Interfaces.C.long;
   use Linux_Calls;

   function Speed_Command (Rate : Nominal_Rate) return String;
   --  The command S of slcan; nothing where it has no digit for Rate.

   function Data_Speed_Command (Bus : Bus_Setting) return String;
   --  The command Y of slcan adapters with CAN FD; nothing without need.

   -------------------
   -- Speed_Command --
   -------------------

   function Speed_Command (Rate : Nominal_Rate) return String is
      Usual : constant array (Character range '0' .. '8') of Nominal_Rate :=
        (10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000,
         800_000, 1_000_000);
   begin
      for Digit in Usual'Range loop
         if Usual (Digit) = Rate then
            return "S" & Digit & ASCII.CR;
         end if;
      end loop;
      return "";
   end Speed_Command;

   ------------------------
   -- Data_Speed_Command --
   ------------------------

   function Data_Speed_Command (Bus : Bus_Setting) return String
   is (if Bus.Takes_Fd
         and then Bus.Data_Rate in 1_000_000 .. 8_000_000
         and then Bus.Data_Rate mod 1_000_000 = 0
       then "Y" & Character'Val
                    (Character'Pos ('0') + Bus.Data_Rate / 1_000_000)
            & ASCII.CR
       else "");

   ----------
   -- Open --
   ----------

   procedure Open (Bus : Bus_Setting; Line : out Sockets.Socket) is
      Path    : constant String := Setting ("RAVENCHART_CAN_DEVICE");
      Speed   : constant String := Setting ("RAVENCHART_CAN_SPEED");
      C_Path  : constant String := Path & ASCII.NUL;
      Modes   : aliased Line_Settings := (others => 0);
      Rate    : constant String :=
        (if Speed = "" then Speed_Command (Bus.Bit_Rate)
         else "S" & Speed & ASCII.CR);
      Opening : constant String :=
        "C" & ASCII.CR & Rate & Data_Speed_Command (Bus) & "O" & ASCII.CR;
      File    : C_Int;
      Result  : C_Int;
   begin
      Line := Sockets.No_Socket;
      if Speed'Length > 1 or else (for some C of Speed => C not in '0' .. '8')
      then
         Sockets.Complain ("RAVENCHART_CAN_SPEED must be a digit, 0 to 8");
         return;
      end if;
      File := C_Open
        (C_Path'Address, Both_Directions + No_Terminal + Close_On_Exec);
      if File < 0 then
         Sockets.Complain (Path & " cannot be opened: trying again");
         return;
      end if;
      Result := C_Get_Line (File, Modes'Address);
      if Result = 0 then
         C_Make_Raw (Modes'Address);
         Result := C_Set_Line (File, At_Once, Modes'Address);
      end if;
      if Result /= 0
        or else C_Write (File, Opening'Address, Opening'Length)
                /= Opening'Length
      then
         Sockets.Complain (Path & " is no serial line: trying again");
         Result := C_Close (File);
         return;
      end if;
      Sockets.Announce ("slcan on " & Path);
      Line := Sockets.Socket (File);
   end Open;

   ---------
   -- Ask --
   ---------

   procedure Ask (Wanted : out Boolean) is
   begin
      Wanted := Setting ("RAVENCHART_CAN_DEVICE") /= "";
   end Ask;

end Ravenchart.Can.Serial_Lines;
