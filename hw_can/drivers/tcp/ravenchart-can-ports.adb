--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Ports
  with SPARK_Mode
is
   use type Interfaces.Unsigned_16;

   ----------
   -- Read --
   ----------

   procedure Read
     (Variable : String;
      Default  : Port;
      Number   : out Port;
      Is_Sound : out Boolean)
   is
      Text : constant String := Driver_Hosts.Setting (Variable);
      Sum  : Natural := 0;
   begin
      Number   := Default;
      Is_Sound := True;
      if Text /= "" then
         for C of Text loop
            if C in '0' .. '9' and then Sum <= 65_535 then
               Sum := 10 * Sum + Character'Pos (C) - Character'Pos ('0');
            else
               Is_Sound := False;
            end if;
         end loop;
         Is_Sound := Is_Sound and then Sum <= 65_535;
         if Is_Sound then
            Number := Port (Sum);
         else
            Driver_Hosts.Complain (Variable, " must be a port, 0 to 65535");
         end if;
      end if;
   end Read;

   -----------
   -- Image --
   -----------

   function Image (Number : Port) return String is
      Text : String (1 .. 5) := (others => '0');
      Rest : Port := Number;
   begin
      for Place in reverse Text'Range loop
         Text (Place) :=
           Character'Val (Character'Pos ('0') + Integer (Rest mod 10));
         Rest := Rest / 10;
         if Rest = 0 then
            return Text (Place .. Text'Last);
         end if;
      end loop;
      return Text;
   end Image;

end Ravenchart.Can.Ports;
