--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Long_Long_Integer_Text_IO;
with Ada.Strings.Unbounded;
with Ada.Text_IO;

package body Ravenchart.Steps is

   use Ada.Strings.Unbounded;

   Time : Long_Long_Integer := 0;
   Line : Unbounded_String;

   function Seconds (Instant : Long_Long_Integer) return String;
   --  Instant in s, with 3, 6 or 9 decimals: as few as are exact.

   -------------
   -- Seconds --
   -------------

   function Seconds (Instant : Long_Long_Integer) return String is
      Whole  : constant String := Long_Long_Integer'Image (Instant / 10**9);
      Rest   : constant String :=
        Long_Long_Integer'Image (10**9 + Instant mod 10**9);
      Digit  : constant String (1 .. 9) := Rest (Rest'Last - 8 .. Rest'Last);
      Last   : Positive := 9;
   begin
      while Last > 3 and then Digit (Last - 2 .. Last) = "000" loop
         Last := Last - 3;
      end loop;
      return Whole (2 .. Whole'Last) & "." & Digit (1 .. Last);
   end Seconds;

   --------------
   -- Set_Time --
   --------------

   procedure Set_Time (Now : Long_Long_Integer) is
   begin
      Time := Now;
   end Set_Time;

   ---------
   -- Now --
   ---------

   function Now return Long_Long_Integer
   is (Time);

   ----------
   -- Note --
   ----------

   procedure Note (Behaviour : String) is
   begin
      if Length (Line) > 0 then
         Append (Line, ", ");
      end if;
      Append (Line, Behaviour);
   end Note;

   ------------
   -- Finish --
   ------------

   procedure Finish (Region : String) is
   begin
      if Length (Line) > 0 then
         Ada.Text_IO.Put_Line
           (Seconds (Time) & " " & Region & ": " & To_String (Line));
         Line := Null_Unbounded_String;
      end if;
   end Finish;

   ---------------
   -- Put_Value --
   ---------------

   procedure Put_Value (Element : String; Value : Number) is
      Image : constant String := Value'Image;
      First : constant Positive :=
        (if Value < 0 then Image'First else Image'First + 1);
   begin
      Ada.Text_IO.Put_Line
        (Seconds (Time) & " " & Element & " = "
         & Image (First .. Image'Last));
   end Put_Value;

   ---------
   -- Get --
   ---------

   procedure Get (Value : out Long_Long_Integer) is
   begin
      Ada.Long_Long_Integer_Text_IO.Get (Value);
   end Get;

end Ravenchart.Steps;
