--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The driver of a drive: an encoder that counts in two's complement, and a
--  DAC of 10 bits whose middle is no current.

with Interfaces;

package body Registers_Feature.Drive
with SPARK_Mode
is
   use type Interfaces.Unsigned_8;
   use type Interfaces.Unsigned_16;
   use type Interfaces.Unsigned_32;
   use type Ravenchart.Number;

   Enabled : constant Interfaces.Unsigned_8  := 16#01#;
   Sound   : constant Interfaces.Unsigned_16 := 16#0001#;
   Limit   : constant Interfaces.Unsigned_16 := 16#0002#;
   Middle  : constant := 512;
   --  Of the DAC: no current.

   function Signed (Count : Interfaces.Unsigned_32) return Ravenchart.Number
   is (if Count < 2**31
       then Ravenchart.Number (Count)
       else Ravenchart.Number (Count) - 2**32)
   with
     Global => null,
     Post   => Signed'Result in -2**31 .. 2**31 - 1;

   function Position
     (Unit : Drive_Units.Unit; Count : Interfaces.Unsigned_32) return Angle
   with Global => null;
   --  Count in mrad, at the end of the range where it is beyond.

   function Position
     (Unit : Drive_Units.Unit; Count : Interfaces.Unsigned_32) return Angle
   is
      Way   : constant Ravenchart.Number :=
        (case Drive_Units.Mounting (Unit) is
           when Forward  => 1,
           when Backward => -1);
      Moved : constant Ravenchart.Number :=
        Way * Signed (Count)
        / Ravenchart.Number (Drive_Units.Counts_Per_Mrad (Unit));
   begin
      return
        Angle (Ravenchart.Number'Max
                 (-1_000, Ravenchart.Number'Min (1_000, Moved)));
   end Position;

   procedure Initialise
     (Unit   : Drive_Units.Unit;
      Device : in out Drive_States.State;
      Passed : out Boolean) is
   begin
      Device.Zero := 0;
      Drive_Registers.Write_Dac (Unit, Middle);
      Drive_Registers.Write_Control (Unit, Enabled);
      Passed := True;
   end Initialise;

   procedure Self_Test
     (Unit   : Drive_Units.Unit;
      Device : in out Drive_States.State;
      Passed : out Boolean)
   is
      pragma Unreferenced (Device);
      Control : Interfaces.Unsigned_8;
      Status  : Interfaces.Unsigned_16;
   begin
      Drive_Registers.Read_Control (Unit, Control);
      Drive_Registers.Read_Status (Unit, Status);
      Passed := Control = Enabled and then (Status and Sound) /= 0;
   end Self_Test;

   procedure Make_Safe
     (Unit : Drive_Units.Unit; Device : in out Drive_States.State)
   is
      pragma Unreferenced (Device);
   begin
      Drive_Registers.Write_Dac (Unit, Middle);
      Drive_Registers.Write_Control (Unit, 0);
   end Make_Safe;

   procedure Get_Position
     (Unit   : Drive_Units.Unit;
      Device : in out Drive_States.State;
      Reply  : out Angle)
   is
      pragma Unmodified (Device);
      Count : Interfaces.Unsigned_32;
      Moved : Ravenchart.Number;
   begin
      Drive_Registers.Read_Count (Unit, Count);
      Moved := Ravenchart.Number (Position (Unit, Count))
        - Ravenchart.Number (Device.Zero);
      Reply :=
        Angle (Ravenchart.Number'Max
                 (-1_000, Ravenchart.Number'Min (1_000, Moved)));
   end Get_Position;

   procedure Set_Current
     (Unit     : Drive_Units.Unit;
      Device   : in out Drive_States.State;
      Argument : Current)
   is
      pragma Unreferenced (Device);
   begin
      Drive_Registers.Write_Dac
        (Unit,
         Interfaces.Unsigned_32
           (Middle + Ravenchart.Number (Argument)));
   end Set_Current;

   procedure Calibrate
     (Unit     : Drive_Units.Unit;
      Device   : in out Drive_States.State;
      Argument : Angle;
      Reply    : out Angle)
   is
      Count : Interfaces.Unsigned_32;
   begin
      Drive_Registers.Read_Count (Unit, Count);
      Reply := Device.Zero;
      Device.Zero :=
        Angle (Ravenchart.Number'Max
                 (-1_000,
                  Ravenchart.Number'Min
                    (1_000,
                     Ravenchart.Number (Position (Unit, Count))
                     - Ravenchart.Number (Argument))));
   end Calibrate;

   procedure Limit_Reached
     (Unit      : Drive_Units.Unit;
      Device    : in out Drive_States.State;
      Is_Raised : out Boolean;
      Argument  : out Angle)
   is
      Status : Interfaces.Unsigned_16;
      Count  : Interfaces.Unsigned_32;
      Is_At  : Boolean;
   begin
      Drive_Registers.Read_Status (Unit, Status);
      Drive_Registers.Read_Count (Unit, Count);
      Is_At := (Status and Limit) /= 0;
      Is_Raised := Is_At and not Device.At_Limit;
      Argument := Position (Unit, Count);
      Device.At_Limit := Is_At;
   end Limit_Reached;
end Registers_Feature.Drive;
