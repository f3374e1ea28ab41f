--  A simulated device of the model of Devices_Feature, written once by
--  ravenchart as a starting point: it is yours.

package Devices_Feature.Io_Board_States
with SPARK_Mode
is
   type Call_Count is mod 2 ** 32;

   --  Arguments as they were given last, and replies as they will be given.
   type State is record
      Calls              : Call_Count := 0;
      Get_Position_Reply : Devices_Feature.Angle_X2 :=
        Devices_Feature.Default_Angle_X2;
      Set_Current        : Devices_Feature.Current_X2 :=
        Devices_Feature.Default_Current_X2;
   end record;
end Devices_Feature.Io_Board_States;
