--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Numbers in the format of registers.

with Interfaces;

package Surgical_Robot.Words
with SPARK_Mode
is
   use type Interfaces.Unsigned_32;
   use type Ravenchart.Number;

   subtype Word is Interfaces.Unsigned_32;

   subtype Long is Ravenchart.Number range -2**31 .. 2**31 - 1;
   --  The values of 32 bits in two's complement.

   function Signed (Value : Word) return Long
   is (if Value < 2**31
       then Ravenchart.Number (Value)
       else Ravenchart.Number (Value) - 2**32)
   with Global => null;
   --  Value read as two's complement.

   function Raw (Value : Long) return Word
   is (if Value >= 0 then Word (Value) else Word (Value + 2**32))
   with Global => null;
   --  Value in two's complement.

   function Clamped
     (Value, Limit : Ravenchart.Number) return Ravenchart.Number
   is (Ravenchart.Number'Max (-Limit, Ravenchart.Number'Min (Limit, Value)))
   with
     Global => null,
     Pre    => Limit in 0 .. 2**31,
     Post   => Clamped'Result in -Limit .. Limit;
   --  Value, or the nearer end of -Limit .. Limit.

   Middle : constant := 2_048;
   --  The value of a digital-to-analogue converter for no current.

   function Converted (Value : Current) return Word
   is (Word (Middle + Ravenchart.Number (Value)))
   with Global => null;
   --  The value of such a converter for a current, in mA.
end Surgical_Robot.Words;
