--  A simulated device of the model of Devices_Feature, written once by
--  ravenchart as a starting point: it is yours.

package body Devices_Feature.Io_Board
with SPARK_Mode
is
   use type Io_Board_States.Call_Count;

   procedure Get_Position
     (Device : in out Io_Board_States.State;
      Reply  : out Devices_Feature.Angle_X2) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Get_Position_Reply;
   end Get_Position;

   procedure Set_Current
     (Device   : in out Io_Board_States.State;
      Argument : Devices_Feature.Current_X2) is
   begin
      Device.Calls := Device.Calls + 1;
      Device.Set_Current := Argument;
   end Set_Current;

   procedure Enable (Device : in out Io_Board_States.State) is
   begin
      Device.Calls := Device.Calls + 1;
   end Enable;

   procedure Disable (Device : in out Io_Board_States.State) is
   begin
      Device.Calls := Device.Calls + 1;
   end Disable;
end Devices_Feature.Io_Board;
