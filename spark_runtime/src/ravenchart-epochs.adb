--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Clock_Ticks;

package body Ravenchart.Epochs
  with SPARK_Mode
is
   use type Ada.Real_Time.Time_Span;

   Rate : constant := 1.0 / Ada.Real_Time.Time_Unit;
   --  Ticks of the clock in a second.

   pragma Compile_Time_Error
     (1.0 * Integer'Pos (Integer (Rate)) /= Rate,
      "the clock of this target has no whole number of ticks in a second");

   package Ticks is new Clock_Ticks (Ticks_Per_Second => Integer (Rate));

   function Minute return Ada.Real_Time.Time_Span
   is (Ada.Real_Time.Minutes (1))
   with Global => null;

   function Second return Ada.Real_Time.Time_Span
   is (Ada.Real_Time.Seconds (1))
   with Global => null;

   function Whole_Units
     (Span, Unit : Ada.Real_Time.Time_Span; Limit : Natural) return Natural
   is (Integer'Max (0, Integer'Min (Limit, Span / Unit)))
   with
     Global => null,
     Post   => Whole_Units'Result <= Limit;
   --  Span / Unit, which the caller knows to lie in 0 .. Limit.

   -------------
   -- To_Span --
   -------------

   function To_Span (Length : Nanoseconds) return Ada.Real_Time.Time_Span is
      Parts : constant Ticks.Tick_Span := Ticks.To_Ticks (Length);
   begin
      return Minute * Parts.Minutes
        + Second * Parts.Seconds
        + Ada.Real_Time.Time_Span_Unit * Parts.Ticks;
   end To_Span;

   --------------------
   -- To_Nanoseconds --
   --------------------

   function To_Nanoseconds
     (Span : Ada.Real_Time.Time_Span) return Nanoseconds
   is
      Rest  : Ada.Real_Time.Time_Span := Span;
      Parts : Ticks.Tick_Span;
   begin
      if Span <= Ada.Real_Time.Time_Span_Zero then
         return 0;
      elsif Span >= To_Span (Nanoseconds'Last) then
         return Nanoseconds'Last;
      end if;
      Parts.Minutes := Whole_Units (Rest, Minute, Ticks.Minute_Count'Last);
      Rest := Rest - Minute * Parts.Minutes;
      Parts.Seconds := Whole_Units (Rest, Second, Ticks.Second_Count'Last);
      Rest := Rest - Second * Parts.Seconds;
      Parts.Ticks := Whole_Units
        (Rest, Ada.Real_Time.Time_Span_Unit, Ticks.Tick_Count'Last);
      return Ticks.To_Nanoseconds (Parts);
   end To_Nanoseconds;

   -------------
   -- Instant --
   -------------

   function Instant (Elapsed : Nanoseconds) return Ada.Real_Time.Time
   is (Start + To_Span (Elapsed));

   -----------------
   -- Since_Start --
   -----------------

   procedure Since_Start (Elapsed : out Nanoseconds) is
      Now : constant Ada.Real_Time.Time := Ada.Real_Time.Clock;
   begin
      Elapsed := To_Nanoseconds (Now - Start);
   end Since_Start;

begin
   declare
      Now : constant Ada.Real_Time.Time := Ada.Real_Time.Clock;
   begin
      Start := Now + To_Span (Start_Margin);
   end;
end Ravenchart.Epochs;
