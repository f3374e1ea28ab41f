--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Released is

   procedure Run (Item : Row) is
      use type Ravenchart.Queueing.Take_Status;
      Value  : Natural;
      Status : Ravenchart.Queueing.Take_Status;
   begin
      case Item is
         when Handle =>
            Mailbox.Take (Value, Status);
            Log.Add (Value, Status = Ravenchart.Queueing.Taken);
      end case;
   end Run;

   protected body Log is

      procedure Add (Value : Natural; Taken : Boolean) is
      begin
         Count   := Count + 1;
         Orderly := Orderly and then Taken and then Value = Count;
         Latest  := Ada.Real_Time.Clock;
      end Add;

      function Handled return Natural
      is (Count);

      function In_Order return Boolean
      is (Orderly);

      function Last_At return Ada.Real_Time.Time
      is (Latest);

   end Log;

end Released;
