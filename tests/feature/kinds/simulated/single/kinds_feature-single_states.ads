--  A simulated device of the model of Kinds_Feature, written once by
--  ravenchart as a starting point: it is yours.

package Kinds_Feature.Single_States
with SPARK_Mode
is
   type Call_Count is mod 2 ** 32;

   --  Arguments as they were given last, and replies as they will be given.
   type State is record
      Calls           : Call_Count := 0;
      Home_Reply      : Kinds_Feature.Mode := Kinds_Feature.Off;
      Choose          : Kinds_Feature.Mode := Kinds_Feature.Off;
      Is_Ready_Reply  : Boolean := False;
      Get_Limit       : Kinds_Feature.Far := 100;
      Get_Limit_Reply : Kinds_Feature.Far := 100;
   end record;
end Kinds_Feature.Single_States;
