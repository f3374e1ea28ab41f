--  A simulated device of the model of Devices_Feature, written once by
--  ravenchart as a starting point: it is yours.

package Devices_Feature.Force_Sensor_States
with SPARK_Mode
is
   type Call_Count is mod 2 ** 32;

   --  Arguments as they were given last, and replies as they will be given.
   type State is record
      Calls           : Call_Count := 0;
      Get_Force_Reply : Devices_Feature.Force := 0;
   end record;
end Devices_Feature.Force_Sensor_States;
