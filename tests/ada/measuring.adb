--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Real_Time;
with Ada.Text_IO;

package body Measuring is
   use type Ada.Real_Time.Time;

   Rounds     : constant := 25;
   Operations : constant := 20_000;

   type Figures is array (1 .. Rounds) of Duration;

   generic
      with procedure Operation (Value : Integer);
   function Round_Time return Duration;
   --  The duration of one round, per 1_000_000_000 operations.

   function Round_Time return Duration is
      Start : constant Ada.Real_Time.Time := Ada.Real_Time.Clock;
      Spent : Duration;
   begin
      for Value in 1 .. Operations loop
         Operation (Value);
      end loop;
      Spent := Ada.Real_Time.To_Duration (Ada.Real_Time.Clock - Start);
      return Spent * (1_000_000_000 / Operations);
   end Round_Time;

   function Median (Found : Figures) return Duration is
      Sorted : Figures := Found;
      Held   : Duration;
   begin
      for Last in Sorted'Range loop
         for Place in reverse 2 .. Last loop
            exit when Sorted (Place - 1) <= Sorted (Place);
            Held               := Sorted (Place);
            Sorted (Place)     := Sorted (Place - 1);
            Sorted (Place - 1) := Held;
         end loop;
      end loop;
      return Sorted (Rounds / 2 + 1);
   end Median;

   function Shortest (Found : Figures) return Duration is
      Least : Duration := Found (1);
   begin
      for Time of Found loop
         Least := Duration'Min (Least, Time);
      end loop;
      return Least;
   end Shortest;

   procedure Measure (Name : String) is
      function Time_Of is new Round_Time (Operation);
      Found : Figures;
   begin
      for Round in Found'Range loop
         Found (Round) := Time_Of;
      end loop;
      Ada.Text_IO.Put_Line
        (Name & Natural'Image (Natural (Median (Found))) & " ns");
   end Measure;

   procedure Compare (Name : String) is
      function Time_Of_Generated is new Round_Time (Generated);
      function Time_Of_Hand_Written is new Round_Time (Hand_Written);

      One, Other : Figures;

      function Tenths (Value : Duration) return String is
        (Natural'Image (Natural (Value * 10) / 10) & "."
         & Character'Val
             (Character'Pos ('0') + Natural (Value * 10) mod 10));
   begin
      for Round in Figures'Range loop
         One (Round)   := Time_Of_Generated;
         Other (Round) := Time_Of_Hand_Written;
      end loop;
      Ada.Text_IO.Put_Line
        (Name & " generated" & Tenths (Shortest (One)) & " ns, hand-written"
         & Tenths (Shortest (Other)) & " ns");
   end Compare;

end Measuring;
