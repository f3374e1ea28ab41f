--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Remote_Calls
  with SPARK_Mode, Refined_State => (State => Waiting)
is
   protected Waiting
     with Priority => Ceiling
   is
      procedure Start
        (Number : out Calls.Call_Number; Status : out Queueing.Put_Status);

      procedure Finish
        (Number : Calls.Call_Number; Status : out Calls.Reply_Status);

      procedure Tick (Status : out Calls.Wait_Status);

   private
      Call : Calls.Call;
   end Waiting;

   protected body Waiting is

      procedure Start
        (Number : out Calls.Call_Number; Status : out Queueing.Put_Status) is
      begin
         Calls.Start (Call, Limit, Status);
         Number := Call.Last;
      end Start;

      procedure Finish
        (Number : Calls.Call_Number; Status : out Calls.Reply_Status) is
      begin
         Calls.Finish (Call, Number, Status);
      end Finish;

      procedure Tick (Status : out Calls.Wait_Status) is
      begin
         Calls.Tick (Call, Status);
      end Tick;

   end Waiting;

   procedure Start
     (Number : out Calls.Call_Number; Status : out Queueing.Put_Status)
   with Refined_Global => (In_Out => Waiting)
   is
   begin
      Waiting.Start (Number, Status);
   end Start;

   procedure Finish
     (Number : Calls.Call_Number; Status : out Calls.Reply_Status)
   with Refined_Global => (In_Out => Waiting)
   is
   begin
      Waiting.Finish (Number, Status);
   end Finish;

   procedure Tick (Status : out Calls.Wait_Status)
   with Refined_Global => (In_Out => Waiting)
   is
   begin
      Waiting.Tick (Status);
   end Tick;

end Ravenchart.Remote_Calls;
