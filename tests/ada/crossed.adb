--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Queueing;

package body Crossed is

   use type Ravenchart.Queueing.Take_Status;

   task Reader
   with CPU => 2;

   procedure Note
     (Item : Block; Before : in out Natural; Seen : in out Findings);
   --  Look at one value.

   ----------
   -- Note --
   ----------

   procedure Note
     (Item : Block; Before : in out Natural; Seen : in out Findings)
   is
      Given : constant Natural := Item (Item'Last);
   begin
      if (for some Part of Item => Part /= Given) then
         Seen.Torn := Seen.Torn + 1;
      elsif Given < Before then
         Seen.Backwards := Seen.Backwards + 1;
      elsif Given > Before then
         Seen.Different := Seen.Different + 1;
         if Given > Before + 1 then
            Seen.Left_Out := Seen.Left_Out + 1;
         end if;
         Before := Given;
      end if;
   end Note;

   task body Reader is
      Item   : Block;
      Before : Natural;
      Status : Ravenchart.Queueing.Take_Status;
   begin
      while Last = 0 loop
         null;
      end loop;
      for Now in Stage loop
         Before := 0;
         while Before < Last loop
            Status := Ravenchart.Queueing.Taken;
            case Now is
               when Of_Board =>
                  Board.Read (Item);
               when Of_Sample =>
                  Sample.Take (Item, Status);
               when Of_Queue =>
                  Queue.Take (Item, Status);
            end case;
            if Status = Ravenchart.Queueing.Taken then
               Note (Item, Before, Found (Now));
            end if;
         end loop;
         Done := Done + 1;
      end loop;
      loop
         null;
      end loop;
   end Reader;

end Crossed;
