--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Policy_Queues
  with SPARK_Mode
is
   pragma Assertion_Policy (Ghost => Ignore, Post => Ignore);

   function Length (Q : Queue) return Length_Type
   is (Rings.Length (Q.Places));

   function Highest (Q : Queue) return Length_Type
   is (Q.Most);

   function Lost (Q : Queue) return Event_Count
   is (Q.Given_Up);

   function Nth (Q : Queue; Index : Capacity_Type) return Element_Type
   is (Q.Store (Rings.Place (Q.Places, Index)));

   procedure Append (Q : in out Queue; Item : Element_Type)
   with
     Global => null,
     Pre    => Length (Q) < Q.Capacity,
     Post   =>
       Length (Q) = Length (Q'Old) + 1
       and then Highest (Q) = Length_Type'Max (Highest (Q'Old), Length (Q))
       and then Lost (Q) = Lost (Q'Old)
       and then Nth (Q, Length (Q)) = Item
       and then Keeps (Q, Q'Old, Length (Q'Old));
   --  Append Item behind the newest element.

   procedure Replace_Oldest (Q : in out Queue; Item : Element_Type)
   with
     Global => null,
     Pre    => Length (Q) = Q.Capacity,
     Post   =>
       Length (Q) = Q.Capacity
       and then Highest (Q) = Highest (Q'Old)
       and then Lost (Q) = Lost (Q'Old)
       and then Nth (Q, Q.Capacity) = Item
       and then Moves_Up (Q, Q'Old, Q.Capacity - 1);
   --  Drop the oldest element, and append Item behind the newest.

   ------------
   -- Append --
   ------------

   procedure Append (Q : in out Queue; Item : Element_Type) is
      Newest : Capacity_Type;
   begin
      Q.Most := Length_Type'Max (Q.Most, Length (Q) + 1);
      Rings.Extend (Q.Places, Newest);
      Q.Store (Newest) := Item;
   end Append;

   --------------------
   -- Replace_Oldest --
   --------------------

   procedure Replace_Oldest (Q : in out Queue; Item : Element_Type) is
      Dropped : Capacity_Type;
      Newest  : Capacity_Type;
   begin
      pragma Warnings
        (GNATprove, Off, """Dropped"" is set by*",
         Reason => "what is dropped is not used");
      Rings.Shrink (Q.Places, Dropped);
      pragma Warnings (GNATprove, On, """Dropped"" is set by*");
      Rings.Extend (Q.Places, Newest);
      Q.Store (Newest) := Item;
   end Replace_Oldest;

   ---------
   -- Put --
   ---------

   procedure Put
     (Q         : in out Queue;
      Item      : Element_Type;
      When_Full : Queueing.Overflow_Policy;
      Status    : out Queueing.Put_Status)
   is
   begin
      if Length (Q) < Q.Capacity then
         Append (Q, Item);
         Status := Queueing.Queued;
      elsif When_Full = Queueing.Drop_Oldest then
         Replace_Oldest (Q, Item);
         Q.Given_Up := Next (Q.Given_Up);
         Status     := Queueing.Dropped_Oldest;
      else
         Q.Given_Up := Next (Q.Given_Up);
         Status     := Queueing.Rejected_Full;
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
      if Length (Q) > 0 then
         Rings.Shrink (Q.Places, Oldest);
         Item   := Q.Store (Oldest);
         Status := Queueing.Taken;
      else
         Item   := Null_Element;
         Status := Queueing.Empty;
      end if;
   end Take;

end Ravenchart.Policy_Queues;
