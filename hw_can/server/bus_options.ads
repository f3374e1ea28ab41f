--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The command line of the bus server: words NAME=VALUE.
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
--     log=FILE         a file of the bus: a welcome record, then a record for
--                      each frame and error frame
--     seed=7:1000000   disturbed bits by chance, at least so many ns apart
--     fault=F:K:N:A:B  frame F meets fault K at node N, 0 for all. A: the
--                      bit, the number of overload frames, the ns of delay
--                      or the byte; B: the mask
--     event=T:K:N:I    event K at node N at T ns; I: identifier to babble

with Ravenchart.Can.Bus_Servers;

package Bus_Options is

   Wrong : exception;
   --  A word of the command line is wrong; a message was printed to standard
   --  error.

   Bus : Ravenchart.Can.Bus_Servers.Server;
   --  The bus that the command line describes.

   procedure Read (Port : out Natural);
   --  Read the command line.

   function Log_File return String;
   --  The file for the log of the bus; empty for none.

   function Is_Paced return Boolean;
   --  Does bus time follow the clock?

end Bus_Options;
