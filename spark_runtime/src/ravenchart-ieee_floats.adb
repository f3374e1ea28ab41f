--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Unchecked_Conversion;
with Interfaces;

package body Ravenchart.IEEE_Floats
  with SPARK_Mode
is
   use type Interfaces.Unsigned_64;

   --------------------------
   -- Lemma_Fields_Survive --
   --------------------------

   procedure Lemma_Fields_Survive (Fields : Single_Fields)
   is null;

   procedure Lemma_Fields_Survive (Fields : Double_Fields)
   is null;

   ------------
   -- Raw_Of --
   ------------

   --  SPARK has no conversion between bits and a floating-point number: only
   --  these four functions, outside of SPARK, convert.

   function Raw_Of (Value : Float) return Bits_32
   with SPARK_Mode => Off
   is
      function Pattern is new
        Ada.Unchecked_Conversion (Float, Interfaces.Unsigned_32);
   begin
      return Bits_32 (Pattern (Value));
   end Raw_Of;

   function Raw_Of (Value : Long_Float) return Double_Bits
   with SPARK_Mode => Off
   is
      function Pattern is new
        Ada.Unchecked_Conversion (Long_Float, Interfaces.Unsigned_64);
      Bits : constant Interfaces.Unsigned_64 := Pattern (Value);
   begin
      return (High => Bits_32 (Bits / 2**32), Low => Bits_32 (Bits mod 2**32));
   end Raw_Of;

   --------------
   -- Value_Of --
   --------------

   function Value_Of (Raw : Bits_32) return Float
   with SPARK_Mode => Off
   is
      function Value is new
        Ada.Unchecked_Conversion (Interfaces.Unsigned_32, Float);
   begin
      return Value (Interfaces.Unsigned_32 (Raw));
   end Value_Of;

   function Value_Of (Raw : Double_Bits) return Long_Float
   with SPARK_Mode => Off
   is
      function Value is new
        Ada.Unchecked_Conversion (Interfaces.Unsigned_64, Long_Float);
   begin
      return
        Value
          (Interfaces.Unsigned_64 (Raw.High) * 2**32
           + Interfaces.Unsigned_64 (Raw.Low));
   end Value_Of;

   --------------
   -- To_Float --
   --------------

   procedure To_Float
     (Raw : Bits_32; Value : out Float; Status : out Conversion_Status) is
   begin
      Status := Status_Of (Class_Of (Fields_Of (Raw)));
      Value := (if Status = Finite then Value_Of (Raw) else 0.0);
   end To_Float;

   -------------------
   -- To_Long_Float --
   -------------------

   procedure To_Long_Float
     (Raw    : Double_Bits;
      Value  : out Long_Float;
      Status : out Conversion_Status)
   is
   begin
      Status := Status_Of (Class_Of (Fields_Of (Raw)));
      Value := (if Status = Finite then Value_Of (Raw) else 0.0);
   end To_Long_Float;

end Ravenchart.IEEE_Floats;
