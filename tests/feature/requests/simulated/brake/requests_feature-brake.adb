--  A simulated device of the model of Requests_Feature, written once by
--  ravenchart as a starting point: it is yours.

package body Requests_Feature.Brake
with SPARK_Mode
is
   use type Brake_States.Call_Count;

   procedure Reset
     (Device : in out Brake_States.State;
      Reply  : out Requests_Feature.Outcome) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Reset_Reply;
   end Reset;
end Requests_Feature.Brake;
