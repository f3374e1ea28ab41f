--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One representative instance of the mailbox with logical execution times.

with Ravenchart.Logical_Samples;

package Instance_Logical
  with SPARK_Mode
is
   type Reading is record
      Level : Ravenchart.Number := 0;
      Valid : Boolean := False;
   end record;
   --  Represents a type of a model.

   No_Reading : constant Reading := (others => <>);

   package Sample is new Ravenchart.Logical_Samples
     (Element_Type => Reading,
      Null_Element => No_Reading,
      Depth        => 3);

end Instance_Logical;
