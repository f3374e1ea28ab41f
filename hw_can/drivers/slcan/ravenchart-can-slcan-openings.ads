--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The first commands of a host to an slcan adapter: they set its bit rates
--  and open the channel.
--
--  Guarantees   no state
--  Tasking      none
--  Timing       constant

package Ravenchart.Can.Slcan.Openings
  with SPARK_Mode, Pure
is
   function Is_Speed (Text : String) return Boolean
   is (Text'Length <= 1 and then (for all C of Text => C in '0' .. '8'))
   with Global => null;
   --  Is it a digit of the command S, or empty?

   Length_Limit : constant := 10;

   subtype Opening_Text is String (1 .. Length_Limit);

   procedure Format
     (Bus   : Bus_Setting;
      Speed : String;
      Text  : out Opening_Text;
      Last  : out Natural)
   with
     Global => null,
     Pre    => Is_Speed (Speed),
     Post   => Last <= Length_Limit;
   --  The commands C, S, Y and O. S is sent for the usual bit rates, and Y for
   --  CAN FD with a data bit rate of a whole number of Mbit/s. Speed takes
   --  precedence over the bit rate of Bus.

end Ravenchart.Can.Slcan.Openings;
