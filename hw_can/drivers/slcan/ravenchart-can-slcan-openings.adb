--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Slcan.Openings
  with SPARK_Mode
is
   subtype Digit is Character range '0' .. '8';

   Usual : constant array (Digit) of Nominal_Rate :=
     (10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000, 800_000,
      1_000_000);
   --  The bit rates that the command S has digits for.

   procedure Add
     (Text : in out Opening_Text; Last : in out Natural; Item : String)
   with
     Global => null,
     Pre    =>
       Item'Length <= 2 and then Last <= Length_Limit - 1 - Item'Length,
     Post   => Last = Last'Old + Item'Length + 1;
   --  Append a command and its carriage return.

   ---------
   -- Add --
   ---------

   procedure Add
     (Text : in out Opening_Text; Last : in out Natural; Item : String) is
   begin
      Text (Last + 1 .. Last + Item'Length) := Item;
      Last        := Last + Item'Length + 1;
      Text (Last) := ASCII.CR;
   end Add;

   ------------
   -- Format --
   ------------

   procedure Format
     (Bus   : Bus_Setting;
      Speed : String;
      Text  : out Opening_Text;
      Last  : out Natural)
   is
      Command : String (1 .. 2) := "S0";
   begin
      Text := (others => ASCII.CR);
      Last := 0;
      Add (Text, Last, "C");
      if Speed /= "" then
         Command (2) := Speed (Speed'First);
         Add (Text, Last, Command);
      else
         for Rate in Digit loop
            if Usual (Rate) = Bus.Bit_Rate then
               Command (2) := Rate;
               Add (Text, Last, Command);
               exit;
            end if;
            pragma Loop_Invariant (Last = Last'Loop_Entry);
         end loop;
      end if;
      if Bus.Takes_Fd
        and then Bus.Data_Rate in 1_000_000 .. 8_000_000
        and then Bus.Data_Rate mod 1_000_000 = 0
      then
         Command (1) := 'Y';
         Command (2) :=
           Character'Val (Character'Pos ('0') + Bus.Data_Rate / 1_000_000);
         Add (Text, Last, Command);
      end if;
      Add (Text, Last, "O");
   end Format;

end Ravenchart.Can.Slcan.Openings;
