--  Times of small operations: medians of several rounds, in nanoseconds.

package Measuring is

   generic
      with procedure Operation (Value : Integer);
   procedure Measure (Name : String);
   --  Put the median time of one Operation.

   generic
      with procedure Generated (Value : Integer);
      with procedure Hand_Written (Value : Integer);
   procedure Compare (Name : String);
   --  Put both medians and their ratio; the rounds take turns.

end Measuring;
