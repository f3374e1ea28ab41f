--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  An I/O board: encoders that count in two's complement, and converters whose
--  middle value is no current.

with Surgical_Robot.Words;

package body Surgical_Robot.Io_Board
with SPARK_Mode
is
   use type Ravenchart.Number;
   use type Words.Word;

   Enabled  : constant Words.Word := 1;
   Sound    : constant Words.Word := 1;
   Farthest : constant := 3_000;  --  mrad, the stop of a joint

   function Position
     (Unit : Io_Board_Units.Unit; Count : Words.Word) return Angle
   with Global => null;
   --  A count in whole mrad, rounded down.

   procedure Set_No_Current (Unit : Io_Board_Units.Unit)
   with Global => (In_Out => Io_Board_Registers.Registers);
   --  Set no current on both axes.

   function Position
     (Unit : Io_Board_Units.Unit; Count : Words.Word) return Angle
   is
      Scale : constant Ravenchart.Number :=
        Ravenchart.Number (Io_Board_Units.Counts_Per_Mrad (Unit));
      Whole : constant Words.Long := Words.Signed (Count);
   begin
      return
        Angle (Words.Clamped ((Whole - Whole mod Scale) / Scale, Farthest));
   end Position;

   procedure Set_No_Current (Unit : Io_Board_Units.Unit) is
   begin
      Io_Board_Registers.Write_Dac_1 (Unit, Words.Middle);
      Io_Board_Registers.Write_Dac_2 (Unit, Words.Middle);
   end Set_No_Current;

   procedure Initialise
     (Unit   : Io_Board_Units.Unit;
      Device : in out Io_Board_States.State;
      Passed : out Boolean)
   is
      pragma Unreferenced (Device);
   begin
      Set_No_Current (Unit);
      Io_Board_Registers.Write_Control (Unit, Enabled);
      Passed := True;
   end Initialise;

   procedure Self_Test
     (Unit   : Io_Board_Units.Unit;
      Device : in out Io_Board_States.State;
      Passed : out Boolean)
   is
      pragma Unreferenced (Device);
      Control, Status : Words.Word;
   begin
      Io_Board_Registers.Read_Control (Unit, Control);
      Io_Board_Registers.Read_Status (Unit, Status);
      Passed := Control = Enabled and then (Status and Sound) /= 0;
   end Self_Test;

   procedure Make_Safe
     (Unit : Io_Board_Units.Unit; Device : in out Io_Board_States.State)
   is
      pragma Unreferenced (Device);
   begin
      Set_No_Current (Unit);
      Io_Board_Registers.Write_Control (Unit, 0);
   end Make_Safe;

   procedure Get_Position
     (Unit   : Io_Board_Units.Unit;
      Device : in out Io_Board_States.State;
      Reply  : out Angle_X2)
   is
      pragma Unreferenced (Device);
      Count_1, Count_2 : Words.Word;
   begin
      Io_Board_Registers.Read_Count_1 (Unit, Count_1);
      Io_Board_Registers.Read_Count_2 (Unit, Count_2);
      Reply :=
        (Axis_1 => Position (Unit, Count_1),
         Axis_2 => Position (Unit, Count_2));
   end Get_Position;

   procedure Set_Current
     (Unit     : Io_Board_Units.Unit;
      Device   : in out Io_Board_States.State;
      Argument : Current_X2)
   is
      pragma Unreferenced (Device);
   begin
      Io_Board_Registers.Write_Dac_1
        (Unit, Words.Converted (Argument.Axis_1));
      Io_Board_Registers.Write_Dac_2
        (Unit, Words.Converted (Argument.Axis_2));
   end Set_Current;
end Surgical_Robot.Io_Board;
