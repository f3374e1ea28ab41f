--  A simulated device of the model of Kinds_Feature, written once by
--  ravenchart as a starting point: it is yours.

package body Kinds_Feature.Odd
with SPARK_Mode
is
   use type Odd_States.Call_Count;

   procedure Move_By
     (Device   : in out Odd_States.State;
      Argument : Kinds_Feature.Place;
      Reply    : out Boolean) is
   begin
      Device.Calls := Device.Calls + 1;
      Device.Move_By := Argument;
      Reply := Device.Move_By_Reply;
   end Move_By;

   procedure Get_Pose
     (Device : in out Odd_States.State;
      Reply  : out Kinds_Feature.Pair) is
   begin
      Device.Calls := Device.Calls + 1;
      Reply := Device.Get_Pose_Reply;
   end Get_Pose;

   procedure Look_Up
     (Device   : in out Odd_States.State;
      Argument : Kinds_Feature.Pair;
      Reply    : out Kinds_Feature.Pair) is
   begin
      Device.Calls := Device.Calls + 1;
      Device.Look_Up := Argument;
      Reply := Device.Look_Up_Reply;
   end Look_Up;
end Kinds_Feature.Odd;
