--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Whole text files.

with Ada.Containers.Indefinite_Vectors;

package Files is

   package Line_Vectors is new Ada.Containers.Indefinite_Vectors
     (Index_Type => Positive, Element_Type => String);

   subtype Line_List is Line_Vectors.Vector;

   Not_There : exception;

   function Text_Of (Path : String) return String;
   --  Not_There where it cannot be read.

   function Lines_Of (Path : String) return Line_List;
   --  The same in lines.

   procedure Write (Path, Text : String);
   --  Complete at once for those who read it.

   procedure Copy (From, To : String);

   function Time_Of (Path : String) return String;
   --  When it was last changed, as ALI files have it: YYYYMMDDhhmmss, UTC.

   procedure Touch (Path : String);
   --  Its time becomes now.

end Files;
