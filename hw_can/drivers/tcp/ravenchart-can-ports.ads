--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Numbers of TCP ports, as the environment gives them.
--
--  Guarantees   a setting that is no port is refused with a message
--  Tasking      the tasks of a driver; each call is independent
--  Timing       linear in the length of a setting

with Interfaces;
with Ravenchart.Can.Driver_Hosts;

package Ravenchart.Can.Ports
  with SPARK_Mode
is
   subtype Port is Interfaces.Unsigned_16;

   procedure Read
     (Variable : String;
      Bus_Name : String;
      Bus      : Bus_Place;
      Default  : Port;
      Number   : out Port;
      Is_Sound : out Boolean)
   with
     Global => (In_Out => Driver_Hosts.Console),
     Pre    => Variable'Length <= Driver_Hosts.Text_Limit;
   --  The port that Variable gives a bus, as Driver_Hosts.Read_Setting finds
   --  it; Default when it is not set. Otherwise Is_Sound is False, with a
   --  message on standard error.

end Ravenchart.Can.Ports;
