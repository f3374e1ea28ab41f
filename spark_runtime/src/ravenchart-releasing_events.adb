--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Synchronous_Task_Control;
with Ravenchart.Queues;

package body Ravenchart.Releasing_Events
  with
    SPARK_Mode,
    Refined_State => (State => Elements.State, Wake_Up => Filled)
is
   use Ada.Synchronous_Task_Control;

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
      Policy       => Policy);

   Filled : Suspension_Object;
   --  True when an element may have come since the caller of Wait last looked.

   procedure Put
     (Item      : Element_Type;
      Status    : out Queueing.Put_Status;
      When_Full : Queueing.Overflow_Policy := Policy)
   with Refined_Global => (In_Out => (Elements.State, Filled))
   is
   begin
      Elements.Put (Item, Status, When_Full);
      Set_True (Filled);
   end Put;

   procedure Take (Item : out Element_Type; Status : out Queueing.Take_Status)
   with Refined_Global => (In_Out => Elements.State)
   is
   begin
      Elements.Take (Item, Status);
   end Take;

   procedure Wait
   with Refined_Global => (Input => Elements.State, In_Out => Filled)
   is
      Nothing_Waits : Boolean;
   begin
      loop
         Nothing_Waits := Elements.Is_Empty;
         exit when not Nothing_Waits;
         Suspend_Until_True (Filled);
      end loop;
   end Wait;

   procedure Read_Fill (Found : out Queueing.Fill)
   with Refined_Global => (Input => Elements.State)
   is
   begin
      Elements.Read_Fill (Found);
   end Read_Fill;

   function Is_Empty return Boolean
   with Refined_Global => Elements.State
   is
   begin
      return Elements.Is_Empty;
   end Is_Empty;

   function Lost return Event_Count
   with Refined_Global => Elements.State
   is
   begin
      return Elements.Lost;
   end Lost;

end Ravenchart.Releasing_Events;
