--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Synchronous_Task_Control;
with Ravenchart.Queues;

package body Ravenchart.Waiting_Queues
  with
    SPARK_Mode,
    Refined_State => (State => Elements.State, Wake_Up => Filled)
is
   use Ada.Synchronous_Task_Control;
   use type Queueing.Take_Status;

   pragma Warnings
     (GNATprove, Off, "no Always_Terminates aspect available*",
      Reason => "ASM-008, the library does not say it of suspension objects");
   pragma Warnings
     (GNATprove, Off, "assuming * always terminates",
      Reason => "ASM-008, the library does not say it of suspension objects");

   package Elements is new Queues
     (Element_Type => Element_Type,
      Null_Element => Null_Element,
      Capacity     => Capacity,
      Ceiling      => Ceiling,
      Policy       => Queueing.Reject_Newest);

   Filled : Suspension_Object;
   --  True when an element may have come since the caller of Wait looked.

   procedure Put (Item : Element_Type; Status : out Queueing.Put_Status)
   with Refined_Global => (In_Out => (Elements.State, Filled))
   is
   begin
      Elements.Put (Item, Status);
      Set_True (Filled);
   end Put;

   procedure Wait (Item : out Element_Type)
   with Refined_Global => (In_Out => (Elements.State, Filled))
   is
      Status : Queueing.Take_Status;
   begin
      loop
         Elements.Take (Item, Status);
         exit when Status = Queueing.Taken;
         Suspend_Until_True (Filled);
      end loop;
   end Wait;

   function Lost return Event_Count
   with Refined_Global => Elements.State
   is
   begin
      return Elements.Lost;
   end Lost;

end Ravenchart.Waiting_Queues;
