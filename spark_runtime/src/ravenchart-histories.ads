--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The last values of a datum, the newest first, each with the instant from
--  which on it is visible.
--
--  Guarantees   stated in full by the contracts
--  Tasking      none of its own
--  Timing       linear in Depth

generic
   type Element_Type is private;
   Null_Element : Element_Type;
   --  The item of a place that has no value yet.
   Depth : Positive;
   --  How many values are kept.
package Ravenchart.Histories
  with SPARK_Mode, Pure
is
   subtype Place is Positive range 1 .. Depth;

   subtype Place_Count is Natural range 0 .. Depth;

   type Stamped is record
      Item    : Element_Type := Null_Element;
      Visible : Nanoseconds  := 0;
   end record;

   type Stamped_List is array (Place) of Stamped;

   type History is record
      Count : Place_Count  := 0;
      Last  : Stamped_List := (others => <>);
   end record;
   --  The first Count places of Last have values.

   procedure Put
     (H : in out History; Item : Element_Type; Visible : Nanoseconds)
   with
     Global => null,
     Post   =>
       H.Count > 0
       and then H.Last (1) = (Item, Visible)
       and then
         (if H.Count'Old > 0 and then H.Last'Old (1).Visible = Visible then
            H.Count = H.Count'Old
            and then (for all I in 2 .. H.Count => H.Last (I) = H.Last'Old (I))
          else
            H.Count
            = (if H.Count'Old = Depth then Depth else H.Count'Old + 1)
            and then
              (for all I in 2 .. H.Count =>
                 H.Last (I) = H.Last'Old (I - 1)));
   --  Add a value. It replaces the newest one where that has the same instant,
   --  else the oldest of Depth values goes.

   function Newest (H : History; Now : Nanoseconds) return Place_Count
   with
     Global => null,
     Post   =>
       Newest'Result <= H.Count
       and then
         (if Newest'Result > 0 then H.Last (Newest'Result).Visible <= Now)
       and then
         (for all I in 1 .. H.Count =>
            (if Newest'Result = 0 or else I < Newest'Result then
               H.Last (I).Visible > Now));
   --  The place of the newest value that is visible at Now; 0 where none is.

end Ravenchart.Histories;
