--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Conversions of floating-point numbers, line by line. Input: RAW of 32 bits,
--  or HIGH LOW of 64. Output: STATUS, CLASS, SIGN, EXPONENT and FRACTION of
--  the fields. If there is a value, MANTISSA and SCALE follow, with value =
--  MANTISSA * 2 ** SCALE, and then the raw bits of the value that is computed
--  from these two.

with Ada.Text_IO;
with Ravenchart;
with Ravenchart.IEEE_Floats;

procedure Float_Lines is
   use Ravenchart;
   use Ravenchart.IEEE_Floats;

   package Numbers is new Ada.Text_IO.Integer_IO (Ravenchart.Number);

   procedure Show
     (Status             : Conversion_Status;
      Class              : Number_Class;
      Negative           : Boolean;
      Exponent, Fraction : Number);

   procedure Single (Raw : Bits_32);

   procedure Double (Raw : Double_Bits);

   ----------
   -- Show --
   ----------

   procedure Show
     (Status             : Conversion_Status;
      Class              : Number_Class;
      Negative           : Boolean;
      Exponent, Fraction : Number) is
   begin
      Ada.Text_IO.Put
        (Status'Image
         & " "
         & Class'Image
         & " "
         & (if Negative then "-" else "+")
         & " "
         & Exponent'Image
         & " "
         & Fraction'Image);
   end Show;

   ------------
   -- Single --
   ------------

   procedure Single (Raw : Bits_32) is
      Fields   : constant Single_Fields := Fields_Of (Raw);
      Value    : Float;
      Status   : Conversion_Status;
      Mantissa : Number;
   begin
      To_Float (Raw, Value, Status);
      Show
        (Status,
         Class_Of (Fields),
         Fields.Negative,
         Fields.Exponent,
         Fields.Fraction);
      if Status = Finite then
         Mantissa := Number (Float'Scaling (Float'Fraction (Value), 24));
         Ada.Text_IO.Put
           (" "
            & Mantissa'Image
            & " "
            & Integer'Image (Float'Exponent (Value) - 24)
            & " "
            & Bits_32'Image
                (Raw_Of
                   (Float'Scaling
                      (Float (Mantissa), Float'Exponent (Value) - 24))));
      end if;
   end Single;

   ------------
   -- Double --
   ------------

   procedure Double (Raw : Double_Bits) is
      Fields   : constant Double_Fields := Fields_Of (Raw);
      Value    : Long_Float;
      Status   : Conversion_Status;
      Mantissa : Number;
      Again    : Double_Bits;
   begin
      To_Long_Float (Raw, Value, Status);
      Show
        (Status,
         Class_Of (Fields),
         Fields.Negative,
         Fields.Exponent,
         Fields.Fraction);
      if Status = Finite then
         Mantissa :=
           Number (Long_Float'Scaling (Long_Float'Fraction (Value), 53));
         Again :=
           Raw_Of
             (Long_Float'Scaling
                (Long_Float (Mantissa), Long_Float'Exponent (Value) - 53));
         Ada.Text_IO.Put
           (" "
            & Mantissa'Image
            & " "
            & Integer'Image (Long_Float'Exponent (Value) - 53)
            & " "
            & Again.High'Image
            & " "
            & Again.Low'Image);
      end if;
   end Double;

   First, Second : Number;
begin
   while not Ada.Text_IO.End_Of_File loop
      Numbers.Get (First);
      if Ada.Text_IO.End_Of_Line then
         Single (First);
      else
         Numbers.Get (Second);
         Double ((High => First, Low => Second));
      end if;
      Ada.Text_IO.Skip_Line;
      Ada.Text_IO.New_Line;
   end loop;
end Float_Lines;
