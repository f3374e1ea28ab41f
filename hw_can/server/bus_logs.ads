--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The log of the bus: frames and error frames, written to a file as records
--  of docs/bus-protocol.md.

package Bus_Logs is

   procedure Open;
   --  Begin the file that Bus_Options names, if any, with a welcome record.
   --  Raises Bus_Options.Wrong, with a message on standard error.

   procedure Write;
   --  Write the records kept since the last call. A slow reader delays the
   --  bus.

   procedure Close;
   --  Close the file.

end Bus_Logs;
