--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Serial lines of the host.
--
--  Guarantees   a line that is not there shows as No_Socket
--  Tasking      one task
--  Timing       that of the system

with Ravenchart.Can.Sockets;

package Ravenchart.Can.Serial_Lines
  with SPARK_Mode
is
   type Outcome is (Opened, No_Device, No_Line);
   --  No_Device: there is no such file, or not for us. No_Line: it is
   --  something else, or does not take what is written.

   Path_Limit : constant := 1_024;

   procedure Open
     (Path   : String;
      First  : String;
      Line   : out Sockets.Socket;
      Result : out Outcome)
   with
     Global => (In_Out => Sockets.Network),
     Pre    => Path'Length <= Path_Limit;
   --  Open the line that Path names as it is set, without echo and
   --  translation, and write First; No_Socket when it is not Opened.

end Ravenchart.Can.Serial_Lines;
