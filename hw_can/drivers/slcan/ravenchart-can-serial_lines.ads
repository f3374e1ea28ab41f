--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Serial lines of the host.
--
--  Guarantees   a line that does not exist shows as No_Socket
--  Tasking      one task
--  Timing       that of the system

with Ravenchart.Can.Sockets;

package Ravenchart.Can.Serial_Lines
  with SPARK_Mode
is
   type Outcome is (Opened, No_Device, No_Line);
   --  No_Device: the file does not exist, or access is denied. No_Line: it is
   --  no serial line, or does not accept the bytes.

   Path_Limit : constant := 1_024;

   procedure Open
     (Path   : String;
      First  : String;
      Line   : out Sockets.Socket;
      Result : out Outcome)
   with
     Global => (In_Out => Sockets.Network),
     Pre    => Path'Length <= Path_Limit;
   --  Open the line that Path names with its settings, without echo and
   --  translation, and write First; No_Socket when it is not Opened.

end Ravenchart.Can.Serial_Lines;
