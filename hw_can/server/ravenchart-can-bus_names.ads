--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The name of a bus.
--
--  Guarantees   a name is one that a welcome can carry
--  Tasking      none
--  Timing       linear in the name

with Ravenchart.Can.Bus_Records;

package Ravenchart.Can.Bus_Names
  with SPARK_Mode, Pure
is
   type Bus_Name is private
   with Default_Initial_Condition => Text (Bus_Name) = "-";

   function Text (Name : Bus_Name) return String
   with
     Global => null,
     Post   =>
       Text'Result'First = 1 and then Bus_Records.Is_Name (Text'Result);
   --  The characters of the name.

   function Named (Text : String) return Bus_Name
   with
     Global => null,
     Pre    => Bus_Records.Is_Name (Text),
     Post   => Bus_Names.Text (Named'Result) = Text;
   --  The name with these characters.

private

   type Bus_Name is record
      Length  : Bus_Records.Name_Length := 1;
      Letters : String (1 .. Bus_Records.Name_Length'Last) :=
        (others => '-');
   end record
   with Type_Invariant => Bus_Records.Is_Name (Letters (1 .. Length));

   function Text (Name : Bus_Name) return String
   is (Name.Letters (1 .. Name.Length));

end Ravenchart.Can.Bus_Names;
