--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Counting with SPARK_Mode is
   Counted : Ravenchart.Event_Count := 0;
   --  Of the processor alone.

   procedure Execute (Item : Row) is
   begin
      case Item is
         when Count => Counted := Ravenchart.Next (Counted);
         when Show  => Shown.Write (Counted);
      end case;
   end Execute;
end Counting;
