--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Bounded_Fifos
  with SPARK_Mode
is
   pragma Assertion_Policy (Ghost => Ignore);

   function Length (Queue : Fifo) return Length_Type
   is (Rings.Length (Queue.Places));

   function Nth (Queue : Fifo; Index : Capacity_Type) return Element_Type
   is (Queue.Store (Rings.Place (Queue.Places, Index)));

   ---------
   -- Put --
   ---------

   procedure Put (Queue : in out Fifo; Item : Element_Type) is
      Newest : Capacity_Type;
   begin
      Rings.Extend (Queue.Places, Newest);
      Queue.Store (Newest) := Item;
   end Put;

   ---------
   -- Get --
   ---------

   procedure Get (Queue : in out Fifo; Item : out Element_Type) is
      Oldest : Capacity_Type;
   begin
      Rings.Shrink (Queue.Places, Oldest);
      Item := Queue.Store (Oldest);
   end Get;

   --------------------
   -- Replace_Oldest --
   --------------------

   procedure Replace_Oldest (Queue : in out Fifo; Item : Element_Type) is
      Dropped : Capacity_Type;
      Newest  : Capacity_Type;
   begin
      pragma Warnings
        (GNATprove, Off, """Dropped"" is set by*",
         Reason => "what is dropped is not used");
      Rings.Shrink (Queue.Places, Dropped);
      pragma Warnings (GNATprove, On, """Dropped"" is set by*");
      Rings.Extend (Queue.Places, Newest);
      Queue.Store (Newest) := Item;
   end Replace_Oldest;

end Ravenchart.Bounded_Fifos;
