--  A simulated device of the model of Kinds_Feature, written once by
--  ravenchart as a starting point: it is yours.

package Kinds_Feature.Double_States
with SPARK_Mode
is
   type Call_Count is mod 2 ** 32;

   --  Arguments as they were given last, and replies as they will be given.
   type State is record
      Calls           : Call_Count := 0;
      Home_Reply      : Kinds_Feature.Mode_X2 :=
        Kinds_Feature.Default_Mode_X2;
      Choose          : Kinds_Feature.Mode_X2 :=
        Kinds_Feature.Default_Mode_X2;
      Is_Ready_Reply  : Kinds_Feature.Boolean_X2 :=
        Kinds_Feature.Default_Boolean_X2;
      Get_Limit       : Kinds_Feature.Far_X2 :=
        Kinds_Feature.Default_Far_X2;
      Get_Limit_Reply : Kinds_Feature.Far_X2 :=
        Kinds_Feature.Default_Far_X2;
   end record;
end Kinds_Feature.Double_States;
