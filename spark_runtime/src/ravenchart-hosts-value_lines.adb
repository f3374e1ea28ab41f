--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Hosts.Services;

package body Ravenchart.Hosts.Value_Lines
  with SPARK_Mode
is
   subtype Line_Length is Natural range 0 .. 80;
   --  Room for three numbers of 20 characters.

   ---------
   -- Put --
   ---------

   procedure Put (Item : Recorded_Values.Value_Record) is
      Text   : String (1 .. Line_Length'Last) := (others => ' ');
      Length : Line_Length := 0;

      procedure Append (C : Character);
      --  Add C, where there is room.

      procedure Add (Word : String);
      --  Add a blank, and Word without its blanks.

      procedure Append (C : Character) is
      begin
         if Length < Line_Length'Last then
            Length := Length + 1;
            Text (Length) := C;
         end if;
      end Append;

      procedure Add (Word : String) is
      begin
         Append (' ');
         for C of Word loop
            if C /= ' ' then
               Append (C);
            end if;
         end loop;
      end Add;

   begin
      Append ('V');
      Add (Item.At_Time'Image);
      Add (Item.Element'Image);
      Add (Item.Value'Image);
      Append (ASCII.LF);
      Services.Put (Text (1 .. Length));
   end Put;

end Ravenchart.Hosts.Value_Lines;
