--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The region of one input port: has a value ever come, and is it still
--  fresh?
--
--  Guarantees   stated in full by the contract of Handle
--  Tasking      none of its own: the component's port handler owns each Port
--  Timing       constant

generic
   type Value_Type is private;
   Default : Value_Type;
   --  The value before the first arrival.
package Ravenchart.Port_Regions
  with SPARK_Mode, Pure
is
   Never_Stale : constant Execution_Count := Execution_Count'Last;
   --  The limit of a port whose value does not age.

   type Port is record
      Value : Value_Type := Default;
      State : Freshness := Never_Received;
      Age   : Execution_Count := 0;
   end record;
   --  Age counts executions of the handler since the last arrival.

   type Change is (Nothing, Arrival, Became_Stale);
   --  The outcome of one execution of the handler, for the events it raises.

   procedure Handle
     (P       : in out Port;
      Arrived : Boolean;
      Item    : Value_Type;
      Limit   : Execution_Count;
      Outcome : out Change)
   with
     Global         => null,
     Post           =>
       Outcome =
         (if Arrived then Arrival
          elsif P'Old.State = Fresh and then P.Age > Limit then Became_Stale
          else Nothing),
     Contract_Cases =>
       (Arrived                                    =>
          P.Value = Item and then P.State = Fresh and then P.Age = 0,
        not Arrived and then P.State = Never_Received =>
          P.Value = P.Value'Old
          and then P.State = Never_Received
          and then P.Age = P.Age'Old,
        not Arrived and then P.State /= Never_Received =>
          P.Value = P.Value'Old
          and then P.Age =
            (if P.Age'Old = Execution_Count'Last then P.Age'Old
             else P.Age'Old + 1)
          and then P.State =
            (if P.Age > Limit then Stale else P.State'Old));
   --  One execution: take Item when it Arrived, else let the value age. A port
   --  that never received a value stays Never_Received, however long it waits.

end Ravenchart.Port_Regions;
