--  A simulated device of the model of Devices_Feature, written once by
--  ravenchart as a starting point: it is yours.

package body Devices_Feature.Force_Sensor
with SPARK_Mode
is
   use type Force_Sensor_States.Call_Count;

   procedure Get_Force
     (Device : in out Force_Sensor_States.State;
      Reply  : out Devices_Feature.Force) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Get_Force_Reply;
   end Get_Force;
end Devices_Feature.Force_Sensor;
