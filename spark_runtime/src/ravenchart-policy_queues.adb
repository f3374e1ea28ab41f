--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Policy_Queues
  with SPARK_Mode
is
   pragma Assertion_Policy (Ghost => Ignore);

   function Length (Q : Queue) return Length_Type
   is (Rings.Length (Q.Places));

   function Highest (Q : Queue) return Length_Type
   is (Rings.Highest (Q.Places));

   function Lost (Q : Queue) return Event_Count
   is (Rings.Lost (Q.Places));

   function Nth (Q : Queue; Index : Capacity_Type) return Element_Type
   is (Q.Store (Rings.Place (Q.Places, Index)));

   ---------
   -- Put --
   ---------

   procedure Put
     (Q         : in out Queue;
      Item      : Element_Type;
      When_Full : Queueing.Overflow_Policy;
      Status    : out Queueing.Put_Status)
   is
      Newest : Capacity_Type;
   begin
      Rings.Put (Q.Places, When_Full, Status, Newest);
      if Status /= Queueing.Rejected_Full then
         Q.Store (Newest) := Item;
      end if;
   end Put;

   ----------
   -- Take --
   ----------

   procedure Take
     (Q      : in out Queue;
      Item   : out Element_Type;
      Status : out Queueing.Take_Status)
   is
      Oldest : Capacity_Type;
   begin
      Rings.Take (Q.Places, Status, Oldest);
      if Status = Queueing.Taken then
         Item := Q.Store (Oldest);
      else
         Item := Null_Element;
      end if;
   end Take;

end Ravenchart.Policy_Queues;
