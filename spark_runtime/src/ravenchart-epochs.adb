package body Ravenchart.Epochs
  with SPARK_Mode
is
   use type Ada.Real_Time.Time_Span;

   Nanoseconds_Per_Second : constant := 1_000_000_000;
   Microseconds_Per_Minute : constant := 60_000_000;
   Nanoseconds_Per_Microsecond : constant := 1_000;

   pragma Compile_Time_Error
     (Ada.Real_Time.Time_Unit > 1.0E-9,
      "Ravenchart counts nanoseconds: the clock of this target is coarser");

   type Wide is range 0 .. 2**63 - 1;
   --  Holds a minute more than Nanoseconds does.

   function Whole_Units
     (Span, Unit : Ada.Real_Time.Time_Span; Limit : Natural) return Natural
   with
     Global => null,
     Post   => Whole_Units'Result <= Limit;
   --  Span / Unit, which the caller knows to lie in 0 .. Limit.

   -----------------
   -- Whole_Units --
   -----------------

   function Whole_Units
     (Span, Unit : Ada.Real_Time.Time_Span; Limit : Natural) return Natural
   is (Integer'Max (0, Integer'Min (Limit, Span / Unit)));

   -------------
   -- To_Span --
   -------------

   function To_Span (Length : Nanoseconds) return Ada.Real_Time.Time_Span is
      Step   : constant := 2**16;
      Whole  : constant Nanoseconds := Length / Nanoseconds_Per_Second;
      Second : constant Ada.Real_Time.Time_Span := Ada.Real_Time.Seconds (1);
   begin
      return Second * Integer (Whole / Step) * Step
        + Second * Integer (Whole mod Step)
        + Ada.Real_Time.Nanoseconds
            (Integer (Length mod Nanoseconds_Per_Second));
   end To_Span;

   --------------------
   -- To_Nanoseconds --
   --------------------

   function To_Nanoseconds
     (Span : Ada.Real_Time.Time_Span) return Nanoseconds
   is
      Longest     : constant Ada.Real_Time.Time_Span :=
        To_Span (Nanoseconds'Last);
      Minute      : constant Ada.Real_Time.Time_Span :=
        Ada.Real_Time.Minutes (1);
      Microsecond : constant Ada.Real_Time.Time_Span :=
        Ada.Real_Time.Microseconds (1);
      Nanosecond  : constant Ada.Real_Time.Time_Span :=
        Ada.Real_Time.Nanoseconds (1);
      Rest        : Ada.Real_Time.Time_Span := Span;
      Minutes     : Natural;
      Micros      : Natural;
      Nanos       : Natural;
   begin
      if Span <= Ada.Real_Time.Time_Span_Zero then
         return 0;
      elsif Span >= Longest then
         return Nanoseconds'Last;
      end if;
      --  The division of spans gives an Integer, so go by units that fit.
      Minutes := Whole_Units (Rest, Minute, 76_861_433);
      Rest    := Rest - Minute * Minutes;
      Micros  := Whole_Units (Rest, Microsecond, Microseconds_Per_Minute - 1);
      Rest    := Rest - Microsecond * Micros;
      Nanos   := Whole_Units
        (Rest, Nanosecond, Nanoseconds_Per_Microsecond - 1);
      return Nanoseconds
        (Wide'Min
           ((Wide (Minutes) * Microseconds_Per_Minute + Wide (Micros))
            * Nanoseconds_Per_Microsecond
            + Wide (Nanos),
            Wide (Nanoseconds'Last)));
   end To_Nanoseconds;

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
