--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One representative instance of a call that goes to all elements of an
--  array.

with Ravenchart.Gatherings;

package Instance_Gatherings
  with SPARK_Mode
is
   type Reading is record
      Level : Ravenchart.Number := 0;
      Valid : Boolean := False;
   end record;
   --  Represents a type of a model.

   No_Reading : constant Reading := (others => <>);

   package Gathering is new Ravenchart.Gatherings
     (Part_Type => Reading,
      No_Part   => No_Reading,
      Last      => 3,
      Ceiling   => 5);

end Instance_Gatherings;
