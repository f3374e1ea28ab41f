--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Can.Bus_Queues
  with SPARK_Mode
is

   ---------
   -- Put --
   ---------

   procedure Put (Q : in out Queue; What : Outgoing) is
   begin
      Q.Count := Q.Count + 1;
      Q.Ring (Place (Q, Q.Count)) := What;
   end Put;

   ---------------
   -- Drop_Head --
   ---------------

   procedure Drop_Head (Q : in out Queue) is
   begin
      Q.First := (if Q.First = Depth then 1 else Q.First + 1);
      Q.Count := Q.Count - 1;
   end Drop_Head;

   -----------
   -- Clear --
   -----------

   procedure Clear (Q : in out Queue) is
   begin
      Q.Count := 0;
   end Clear;

end Ravenchart.Can.Bus_Queues;
