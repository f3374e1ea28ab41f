--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Releasing_Queues;

package body Ravenchart.Waiting_Queues
  with
    SPARK_Mode,
    Refined_State => (State => Elements.State, Wake_Up => Elements.Wake_Up)
is
   use type Queueing.Take_Status;

   package Elements is new Releasing_Queues
     (Element_Type => Element_Type,
      Null_Element => Null_Element,
      Capacity     => Capacity,
      Ceiling      => Ceiling,
      Policy       => Queueing.Reject_Newest);

   procedure Put (Item : Element_Type; Status : out Queueing.Put_Status)
   with Refined_Global => (In_Out => (Elements.State, Elements.Wake_Up))
   is
   begin
      Elements.Put (Item, Status);
   end Put;

   procedure Wait (Item : out Element_Type)
   with Refined_Global => (In_Out => (Elements.State, Elements.Wake_Up))
   is
      Status : Queueing.Take_Status;
   begin
      loop
         Elements.Take (Item, Status);
         exit when Status = Queueing.Taken;
         Elements.Wait;
      end loop;
   end Wait;

   function Lost return Event_Count
   with Refined_Global => Elements.State
   is
   begin
      return Elements.Lost;
   end Lost;

end Ravenchart.Waiting_Queues;
