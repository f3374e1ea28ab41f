--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Drives whose axes go on by a count for each positive step of the DAC, with
--  a limit switch at 300 counts. Each change of a DAC or a control register
--  is a line on standard error; the environment variable BROKEN_DRIVE names a
--  drive that is not sound.

with Ada.Environment_Variables;
with GNAT.IO;
with System;

package body Registers_Feature.Drive_Registers
with SPARK_Mode => Off
is
   use type Interfaces.Unsigned_8;
   use type Interfaces.Unsigned_32;

   type Drive_Model is record
      Control : Interfaces.Unsigned_8  := 0;
      Dac     : Interfaces.Unsigned_32 := 0;
      Count   : Interfaces.Unsigned_32 := 0;
   end record;

   type Drive_Models is array (Drive_Units.Unit) of Drive_Model;

   protected Equipment
   with Priority => System.Priority'Last
   is
      procedure Set_Control
        (Unit : Drive_Units.Unit; Value : Interfaces.Unsigned_8);
      procedure Set_Dac
        (Unit : Drive_Units.Unit; Value : Interfaces.Unsigned_32);
      function Control
        (Unit : Drive_Units.Unit) return Interfaces.Unsigned_8;
      function Count (Unit : Drive_Units.Unit) return Interfaces.Unsigned_32;
   private
      Models : Drive_Models;
   end Equipment;

   protected body Equipment is

      procedure Set_Control
        (Unit : Drive_Units.Unit; Value : Interfaces.Unsigned_8) is
      begin
         if Value /= Models (Unit).Control then
            Models (Unit).Control := Value;
            GNAT.IO.Put (GNAT.IO.Standard_Error, Unit'Image);
            GNAT.IO.Put (GNAT.IO.Standard_Error, " CONTROL");
            GNAT.IO.Put_Line (GNAT.IO.Standard_Error, Value'Image);
         end if;
      end Set_Control;

      procedure Set_Dac
        (Unit : Drive_Units.Unit; Value : Interfaces.Unsigned_32) is
      begin
         if Value /= Models (Unit).Dac then
            Models (Unit).Dac := Value;
            GNAT.IO.Put (GNAT.IO.Standard_Error, Unit'Image);
            GNAT.IO.Put (GNAT.IO.Standard_Error, " DAC");
            GNAT.IO.Put_Line (GNAT.IO.Standard_Error, Value'Image);
         end if;
         Models (Unit).Count := Models (Unit).Count + Value - 512;
      end Set_Dac;

      function Control (Unit : Drive_Units.Unit) return Interfaces.Unsigned_8
      is (Models (Unit).Control);

      function Count (Unit : Drive_Units.Unit) return Interfaces.Unsigned_32
      is (Models (Unit).Count);

   end Equipment;

   procedure Read_Control
     (Unit : Drive_Units.Unit; Value : out Interfaces.Unsigned_8) is
   begin
      Value := Equipment.Control (Unit);
   end Read_Control;

   procedure Write_Control
     (Unit : Drive_Units.Unit; Value : Interfaces.Unsigned_8) is
   begin
      Equipment.Set_Control (Unit, Value);
   end Write_Control;

   procedure Read_Status
     (Unit : Drive_Units.Unit; Value : out Interfaces.Unsigned_16) is
   begin
      Value :=
        (if Ada.Environment_Variables.Value ("BROKEN_DRIVE", "") = Unit'Image
         then 0
         elsif Equipment.Count (Unit) in 300 .. 2**31
         then 3
         else 1);
   end Read_Status;

   procedure Read_Count
     (Unit : Drive_Units.Unit; Value : out Interfaces.Unsigned_32) is
   begin
      Value := Equipment.Count (Unit);
   end Read_Count;

   procedure Write_Dac
     (Unit : Drive_Units.Unit; Value : Interfaces.Unsigned_32) is
   begin
      Equipment.Set_Dac (Unit, Value);
   end Write_Dac;
end Registers_Feature.Drive_Registers;
