--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Floating-point numbers of IEEE 754 as the raw bits that frames carry, for
--  the bodies of users. 32 bits are one number of the model; 64 bits are two,
--  the more significant half first.
--
--  Guarantees   raw bits are taken apart and joined without loss; an infinity
--               or a NaN never becomes a value: it has a status of its own
--  Tasking      none: any task may use these subprograms
--  Timing       constant
--  Assumptions  ASM-021, the bodies of Raw_Of and Value_Of do what this
--               specification states

package Ravenchart.IEEE_Floats
  with SPARK_Mode, Pure
is
   subtype Bits_32 is Number range 0 .. 2**32 - 1;
   --  The raw bits of a number of 32 bits, or half of those of 64 bits.

   type Number_Class is (Zero, Subnormal, Normal, Infinite, Not_A_Number);

   type Conversion_Status is (Finite, Infinite, Not_A_Number);
   --  The kind of value that raw bits represent.

   function Status_Of (Class : Number_Class) return Conversion_Status
   is (case Class is
         when Zero | Subnormal | Normal => Finite,
         when Infinite                  => Infinite,
         when Not_A_Number              => Not_A_Number)
   with Global => null;

   --  32 bits

   subtype Single_Exponent is Number range 0 .. 255;
   --  Biased by 127; 255 for infinities and NaNs.

   subtype Single_Fraction is Number range 0 .. 2**23 - 1;

   type Single_Fields is record
      Negative : Boolean;
      Exponent : Single_Exponent;
      Fraction : Single_Fraction;
   end record;

   function Joined (Fields : Single_Fields) return Bits_32
   is ((if Fields.Negative then 2**31 else 0)
       + Fields.Exponent * 2**23
       + Fields.Fraction)
   with Global => null;
   --  The raw bits of the fields.

   function Fields_Of (Raw : Bits_32) return Single_Fields
   is ((Negative => Raw >= 2**31,
        Exponent => Raw / 2**23 mod 2**8,
        Fraction => Raw mod 2**23))
   with Global => null, Post => Joined (Fields_Of'Result) = Raw;
   --  The only fields that have these raw bits.

   procedure Lemma_Fields_Survive (Fields : Single_Fields)
   with
     Ghost,
     Global => null,
     Post   => Fields_Of (Joined (Fields)) = Fields;

   function Class_Of (Fields : Single_Fields) return Number_Class
   is (if Fields.Exponent = Single_Exponent'Last
       then (if Fields.Fraction = 0 then Infinite else Not_A_Number)
       elsif Fields.Exponent > 0
       then Normal
       elsif Fields.Fraction > 0
       then Subnormal
       else Zero)
   with Global => null;

   function Is_Finite (Raw : Bits_32) return Boolean
   is (Fields_Of (Raw).Exponent < Single_Exponent'Last)
   with
     Global => null,
     Post   =>
       Is_Finite'Result = (Status_Of (Class_Of (Fields_Of (Raw))) = Finite);

   function Raw_Of (Value : Float) return Bits_32
   with Global => null, Post => Is_Finite (Raw_Of'Result);
   --  The raw bits to send.

   function Value_Of (Raw : Bits_32) return Float
   with
     Global => null,
     Pre    => Is_Finite (Raw),
     Post   => Raw_Of (Value_Of'Result) = Raw;
   --  The value that finite raw bits represent.

   procedure To_Float
     (Raw : Bits_32; Value : out Float; Status : out Conversion_Status)
   with
     Global => null,
     Post   =>
       Status = Status_Of (Class_Of (Fields_Of (Raw)))
       and then (if Status = Finite
                 then Raw_Of (Value) = Raw
                 else Value = 0.0);
   --  The value that received bits represent; 0.0 unless they are finite.

   --  64 bits

   subtype Double_Exponent is Number range 0 .. 2_047;
   --  Biased by 1023; 2047 for infinities and NaNs.

   subtype Double_Fraction is Number range 0 .. 2**52 - 1;

   type Double_Fields is record
      Negative : Boolean;
      Exponent : Double_Exponent;
      Fraction : Double_Fraction;
   end record;

   type Double_Bits is record
      High : Bits_32;
      Low  : Bits_32;
   end record;
   --  High holds the sign, the exponent, and the first 20 bits of the
   --  fraction.

   function Joined (Fields : Double_Fields) return Double_Bits
   is ((High =>
          (if Fields.Negative then 2**31 else 0)
          + Fields.Exponent * 2**20
          + Fields.Fraction / 2**32,
        Low  => Fields.Fraction mod 2**32))
   with Global => null;
   --  The raw bits of the fields.

   function Fields_Of (Raw : Double_Bits) return Double_Fields
   is ((Negative => Raw.High >= 2**31,
        Exponent => Raw.High / 2**20 mod 2**11,
        Fraction => Raw.High mod 2**20 * 2**32 + Raw.Low))
   with Global => null, Post => Joined (Fields_Of'Result) = Raw;
   --  The only fields that have these raw bits.

   procedure Lemma_Fields_Survive (Fields : Double_Fields)
   with
     Ghost,
     Global => null,
     Post   => Fields_Of (Joined (Fields)) = Fields;

   function Class_Of (Fields : Double_Fields) return Number_Class
   is (if Fields.Exponent = Double_Exponent'Last
       then (if Fields.Fraction = 0 then Infinite else Not_A_Number)
       elsif Fields.Exponent > 0
       then Normal
       elsif Fields.Fraction > 0
       then Subnormal
       else Zero)
   with Global => null;

   function Is_Finite (Raw : Double_Bits) return Boolean
   is (Fields_Of (Raw).Exponent < Double_Exponent'Last)
   with
     Global => null,
     Post   =>
       Is_Finite'Result = (Status_Of (Class_Of (Fields_Of (Raw))) = Finite);

   function Raw_Of (Value : Long_Float) return Double_Bits
   with Global => null, Post => Is_Finite (Raw_Of'Result);
   --  The raw bits to send.

   function Value_Of (Raw : Double_Bits) return Long_Float
   with
     Global => null,
     Pre    => Is_Finite (Raw),
     Post   => Raw_Of (Value_Of'Result) = Raw;
   --  The value that finite raw bits represent.

   procedure To_Long_Float
     (Raw    : Double_Bits;
      Value  : out Long_Float;
      Status : out Conversion_Status)
   with
     Global => null,
     Post   =>
       Status = Status_Of (Class_Of (Fields_Of (Raw)))
       and then (if Status = Finite
                 then Raw_Of (Value) = Raw
                 else Value = 0.0);
   --  The value that received bits represent; 0.0 unless they are finite.

end Ravenchart.IEEE_Floats;
