--  A simulated device of the model of Kinds_Feature, written once by
--  ravenchart as a starting point: it is yours.

package body Kinds_Feature.Double
with SPARK_Mode
is
   use type Double_States.Call_Count;

   procedure Stop (Device : in out Double_States.State) is
   begin
      Device.Calls := Device.Calls + 1;
   end Stop;

   procedure Home
     (Device : in out Double_States.State;
      Reply  : out Kinds_Feature.Mode_X2) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Home_Reply;
   end Home;

   procedure Choose
     (Device   : in out Double_States.State;
      Argument : Kinds_Feature.Mode_X2) is
   begin
      Device.Calls := Device.Calls + 1;
      Device.Choose := Argument;
   end Choose;

   procedure Is_Ready
     (Device : in out Double_States.State;
      Reply  : out Kinds_Feature.Boolean_X2) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Is_Ready_Reply;
   end Is_Ready;

   procedure Get_Limit
     (Device   : in out Double_States.State;
      Argument : Kinds_Feature.Far_X2;
      Reply    : out Kinds_Feature.Far_X2) is
   begin
      Device.Calls := Device.Calls + 1;
      Device.Get_Limit := Argument;
      Reply := Device.Get_Limit_Reply;
   end Get_Limit;
end Kinds_Feature.Double;
