--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Ports
  with SPARK_Mode
is
   Digit_Limit : constant := 32;
   --  A longer text is no port, even with leading zeros.

   ----------
   -- Read --
   ----------

   procedure Read
     (Variable : String;
      Bus_Name : String;
      Bus      : Bus_Place;
      Default  : Port;
      Number   : out Port;
      Is_Sound : out Boolean)
   is
      Text : String (1 .. Digit_Limit + 1);
      Last : Natural;
      Sum  : Natural := 0;
   begin
      Number := Default;
      Driver_Hosts.Read_Setting (Variable, Bus_Name, Text, Last);
      Is_Sound := Last <= Digit_Limit;
      for C of Text (1 .. Last) loop
         if C in '0' .. '9' and then Sum <= 65_535 then
            Sum := 10 * Sum + Character'Pos (C) - Character'Pos ('0');
         else
            Is_Sound := False;
         end if;
      end loop;
      Is_Sound := Is_Sound and then Sum <= 65_535;
      if not Is_Sound then
         Driver_Hosts.Complain
           (Bus, Variable, " must be a port, 0 to 65535");
      elsif Last > 0 then
         Number := Port (Sum);
      end if;
   end Read;

end Ravenchart.Can.Ports;
