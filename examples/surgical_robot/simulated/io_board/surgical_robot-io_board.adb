--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A simulated I/O board: its joints go as fast as they are driven, to a stop.

package body Surgical_Robot.Io_Board
with SPARK_Mode
is
   use type Io_Board_States.Call_Count;
   use type Ravenchart.Number;

   Slowness : constant := 40;  --  mA that move a joint by 1 mrad a call
   Farthest : constant := 3_000;  --  mrad, where a joint has its stop

   function Driven (From : Angle; By : Current) return Angle
   with Global => null;
   --  Where a joint is after a call.

   function Driven (From : Angle; By : Current) return Angle is
      To : constant Ravenchart.Number :=
        Ravenchart.Number (From) + Ravenchart.Number (By) / Slowness;
   begin
      return
        Angle
          (Ravenchart.Number'Max
             (-Farthest, Ravenchart.Number'Min (Farthest, To)));
   end Driven;

   procedure Initialise
     (Device : in out Io_Board_States.State; Passed : out Boolean) is
   begin
      Device.Calls := Device.Calls + 1;
      Passed := True;
   end Initialise;

   procedure Self_Test
     (Device : in out Io_Board_States.State; Passed : out Boolean) is
   begin
      Device.Calls := Device.Calls + 1;
      Passed := True;
   end Self_Test;

   procedure Make_Safe (Device : in out Io_Board_States.State) is
   begin
      Device.Calls := Device.Calls + 1;
      Device.Set_Current := Default_Current_X2;
   end Make_Safe;

   procedure Get_Position
     (Device : in out Io_Board_States.State;
      Reply  : out Surgical_Robot.Angle_X2) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Get_Position_Reply;
   end Get_Position;

   procedure Set_Current
     (Device   : in out Io_Board_States.State;
      Argument : Surgical_Robot.Current_X2) is
   begin
      Device.Calls := Device.Calls + 1;
      Device.Set_Current := Argument;
      Device.Get_Position_Reply :=
        (Axis_1 => Driven (Device.Get_Position_Reply.Axis_1, Argument.Axis_1),
         Axis_2 =>
           Driven (Device.Get_Position_Reply.Axis_2, Argument.Axis_2));
   end Set_Current;
end Surgical_Robot.Io_Board;
