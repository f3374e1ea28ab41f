--  A simulated device of the model of Kinds_Feature, written once by
--  ravenchart as a starting point: it is yours.

package Kinds_Feature.Odd_States
with SPARK_Mode
is
   type Call_Count is mod 2 ** 32;

   --  Arguments as they were given last, and replies as they will be given.
   type State is record
      Calls          : Call_Count := 0;
      Move_By        : Kinds_Feature.Place := 0;
      Move_By_Reply  : Boolean := False;
      Get_Pose_Reply : Kinds_Feature.Pair := Kinds_Feature.Default_Pair;
      Look_Up        : Kinds_Feature.Pair := Kinds_Feature.Default_Pair;
      Look_Up_Reply  : Kinds_Feature.Pair := Kinds_Feature.Default_Pair;
   end record;
end Kinds_Feature.Odd_States;
