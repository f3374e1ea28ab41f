--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What is on the bus, written to a file as records of docs/bus-protocol.md.

package Bus_Logs is

   procedure Open;
   --  Begin the file that Bus_Options names, if it names one, with a welcome
   --  record. Raises Bus_Options.Wrong, with words on standard error.

   procedure Write;
   --  Write what was kept since. A reader that is slow holds up the bus.

   procedure Close;
   --  Nothing more is written.

end Bus_Logs;
