--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Two amplifiers without encoders.

with Surgical_Robot.Words;

package body Surgical_Robot.Amplifier
with SPARK_Mode
is
   use type Words.Word;

   Enabled : constant Words.Word := 1;

   procedure Set_No_Current (Unit : Amplifier_Units.Unit)
   with Global => (In_Out => Amplifier_Registers.Registers);
   --  Set no current on both axes.

   procedure Set_No_Current (Unit : Amplifier_Units.Unit) is
   begin
      Amplifier_Registers.Write_Dac_1 (Unit, Words.Middle);
      Amplifier_Registers.Write_Dac_2 (Unit, Words.Middle);
   end Set_No_Current;

   procedure Initialise
     (Unit   : Amplifier_Units.Unit;
      Device : in out Amplifier_States.State;
      Passed : out Boolean)
   is
      pragma Unreferenced (Device);
      Control : Words.Word;
   begin
      Set_No_Current (Unit);
      Amplifier_Registers.Write_Control (Unit, Enabled);
      Amplifier_Registers.Read_Control (Unit, Control);
      Passed := Control = Enabled;
   end Initialise;

   procedure Make_Safe
     (Unit : Amplifier_Units.Unit; Device : in out Amplifier_States.State)
   is
      pragma Unreferenced (Device);
   begin
      Set_No_Current (Unit);
      Amplifier_Registers.Write_Control (Unit, 0);
   end Make_Safe;

   procedure Set_Current
     (Unit     : Amplifier_Units.Unit;
      Device   : in out Amplifier_States.State;
      Argument : Current_X2)
   is
      pragma Unreferenced (Device);
   begin
      Amplifier_Registers.Write_Dac_1
        (Unit, Words.Converted (Argument.Axis_1));
      Amplifier_Registers.Write_Dac_2
        (Unit, Words.Converted (Argument.Axis_2));
   end Set_Current;
end Surgical_Robot.Amplifier;
