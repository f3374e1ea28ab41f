--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What the bus server is told on its command line: words NAME=VALUE.
--
--     port=29536       0 for a free one
--     name=can0        1 to 16 characters from ! to ~
--     bitrate=500000, data_bitrate=2000000
--                      bit/s; a data bit rate of 0 is a classic bus
--     sample_point=800, data_sample_point=800
--                      of a bit, in thousandths
--     restart_ms=0     from bus-off to the request for recovery; 0: by hand
--     time=paced       or virtual
--     buffer=fifo      or priority
--     log=FILE         writes what is on the bus there: a welcome record, then
--                      a record for each frame and error frame
--     seed=7:1000000   a bit is disturbed, at least so many ns apart
--     fault=F:K:N:A:B  frame F meets fault K at node N, 0 for all. A: the
--                      bit, the number of overload frames, the ns of delay
--                      or the byte; B: the mask
--     event=T:K:N:I    at T ns, K happens to node N; I: identifier to babble

with Ravenchart.Can.Bus_Servers;

package Bus_Options is

   Wrong : exception;
   --  What is told is not like that; it was said on standard error.

   Bus : Ravenchart.Can.Bus_Servers.Server;
   --  As it is told.

   procedure Read (Port : out Natural);
   --  Read the command line.

   function Log_File return String;
   --  Where to write what is on the bus; empty for nowhere.

   function Is_Paced return Boolean;
   --  Does bus time go with the clock?

end Bus_Options;
