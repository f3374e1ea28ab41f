--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A force sensor behind an analogue-to-digital converter of 16 bits.

with Interfaces;
with Surgical_Robot.Words;

package body Surgical_Robot.Force_Sensor
with SPARK_Mode
is
   use type Ravenchart.Number;
   use type Words.Word;

   Start     : constant Words.Word := 1;
   Done      : constant Words.Word := 1;
   Zero      : constant := 2**15;
   --  the value of the converter without force
   Strongest : constant := 5_000;  --  mN
   Tries     : constant := 8;
   --  The most looks until a conversion is done.

   procedure Convert
     (Unit   : Force_Sensor_Units.Unit;
      Is_New : out Boolean;
      Found  : out Force)
   with Global => (In_Out => Force_Sensor_Registers.Registers);
   --  Start a conversion; Found is its result, or 0 unless Is_New.

   procedure Convert
     (Unit   : Force_Sensor_Units.Unit;
      Is_New : out Boolean;
      Found  : out Force)
   is
      Status : Words.Word;
      Sample : Interfaces.Unsigned_16;
   begin
      Is_New := False;
      Found := 0;
      Force_Sensor_Registers.Write_Control (Unit, Start);
      for Try in 1 .. Tries loop
         exit when Is_New;
         Force_Sensor_Registers.Read_Status (Unit, Status);
         Is_New := (Status and Done) /= 0;
      end loop;
      if Is_New then
         Force_Sensor_Registers.Read_Sample (Unit, Sample);
         Found :=
           Force
             (Words.Clamped
                (Ravenchart.Number (Sample) - Zero
                 - Ravenchart.Number (Force_Sensor_Units.Zero (Unit)),
                 Strongest));
      end if;
   end Convert;

   procedure Self_Test
     (Unit   : Force_Sensor_Units.Unit;
      Device : in out Force_Sensor_States.State;
      Passed : out Boolean)
   is
      Found : Force;
   begin
      Convert (Unit, Passed, Found);
      if Passed then
         Device.Last := Found;
      end if;
   end Self_Test;

   procedure Get_Force
     (Unit   : Force_Sensor_Units.Unit;
      Device : in out Force_Sensor_States.State;
      Reply  : out Force)
   is
      Is_New : Boolean;
      Found  : Force;
   begin
      Convert (Unit, Is_New, Found);
      if Is_New then
         Device.Last := Found;
      end if;
      Reply := Device.Last;
   end Get_Force;
end Surgical_Robot.Force_Sensor;
