--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Can.Any_Frames;

package body Driven is

   protected body Taken is

      procedure Note (Id : Ravenchart.Can.Identifier) is
      begin
         Right := Right and then (Seen = 0 or else Id = Last + 1);
         Seen  := Seen + 1;
         Last  := Id;
      end Note;

      function Count return Natural
      is (Seen);

      function In_Order return Boolean
      is (Right);

   end Taken;

   task body Taker is
      Item  : Ravenchart.Can.Any_Frames.Any_Frame;
      Stamp : Ravenchart.Nanoseconds;
   begin
      loop
         Controller.Wait_Frame (Item, Stamp);
         Taken.Note (Ravenchart.Can.Any_Frames.Id (Item));
      end loop;
   end Taker;

end Driven;
