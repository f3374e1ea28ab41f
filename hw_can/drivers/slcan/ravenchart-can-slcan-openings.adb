--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Slcan.Openings
  with SPARK_Mode
is
   Command_Limit : constant := 3;
   --  A letter, a digit and the carriage return.

   function Speed_Command (Rate : Nominal_Rate) return String
   with
     Global => null,
     Post   => Speed_Command'Result'Length <= Command_Limit;
   --  The command S of slcan; nothing where it has no digit for Rate.

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

   function Data_Speed_Command (Bus : Bus_Setting) return String
   is (if Bus.Takes_Fd
         and then Bus.Data_Rate in 1_000_000 .. 8_000_000
         and then Bus.Data_Rate mod 1_000_000 = 0
       then "Y" & Character'Val
                    (Character'Pos ('0') + Bus.Data_Rate / 1_000_000)
            & ASCII.CR
       else "")
   with
     Global => null,
     Post   => Data_Speed_Command'Result'Length <= Command_Limit;
   --  The command Y of slcan adapters with CAN FD; nothing without need.

   -------------
   -- Opening --
   -------------

   function Opening (Bus : Bus_Setting; Speed : String) return String
   is ("C" & ASCII.CR
       & (if Speed = "" then Speed_Command (Bus.Bit_Rate)
          else "S" & Speed & ASCII.CR)
       & Data_Speed_Command (Bus) & "O" & ASCII.CR);

end Ravenchart.Can.Slcan.Openings;
