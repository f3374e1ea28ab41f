--  A simulated device of the model of Kinds_Feature, written once by
--  ravenchart as a starting point: it is yours.

package body Kinds_Feature.Single
with SPARK_Mode
is
   use type Single_States.Call_Count;

   procedure Stop (Device : in out Single_States.State) is
   begin
      Device.Calls := Device.Calls + 1;
   end Stop;

   procedure Home
     (Device : in out Single_States.State;
      Reply  : out Kinds_Feature.Mode) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Home_Reply;
   end Home;

   procedure Choose
     (Device   : in out Single_States.State;
      Argument : Kinds_Feature.Mode) is
   begin
      Device.Calls := Device.Calls + 1;
      Device.Choose := Argument;
   end Choose;

   procedure Is_Ready
     (Device : in out Single_States.State;
      Reply : out Boolean) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Is_Ready_Reply;
   end Is_Ready;

   procedure Get_Limit
     (Device   : in out Single_States.State;
      Argument : Kinds_Feature.Far;
      Reply    : out Kinds_Feature.Far) is
   begin
      Device.Calls := Device.Calls + 1;
      Device.Get_Limit := Argument;
      Reply := Device.Get_Limit_Reply;
   end Get_Limit;
end Kinds_Feature.Single;
