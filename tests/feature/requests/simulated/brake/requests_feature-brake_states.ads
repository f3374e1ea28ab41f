--  A simulated device of the model of Requests_Feature, written once by
--  ravenchart as a starting point: it is yours.

package Requests_Feature.Brake_States
with SPARK_Mode
is
   type Call_Count is mod 2 ** 32;

   --  Arguments as they were given last, and replies as they will be given.
   type State is record
      Calls       : Call_Count := 0;
      Reset_Reply : Requests_Feature.Outcome := Requests_Feature.Unknown;
   end record;
end Requests_Feature.Brake_States;
