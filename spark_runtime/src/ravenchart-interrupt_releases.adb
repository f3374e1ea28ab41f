--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Synchronous_Task_Control;
with System;

package body Ravenchart.Interrupt_Releases
  with
    SPARK_Mode,
    Refined_State => (State => Gate, Wake_Up => Accepted)
is
   use Ada.Synchronous_Task_Control;

   pragma Warnings
     (GNATprove, Off, "no Always_Terminates aspect available*",
      Reason => "ASM-008, the library does not say it of suspension objects");
   pragma Warnings
     (GNATprove, Off, "assuming * always terminates",
      Reason => "ASM-008, the library does not say it of suspension objects");

   protected Gate
     with Interrupt_Priority => System.Interrupt_Priority'Last
   is
      procedure Note (Now : Nanoseconds; Is_Due : out Boolean);
      --  An interrupt came at Now; whether it releases the processor.

      procedure Take (Found, Too_Soon : out Boolean);
      --  Take a release, if there is one, and the note of the others.
   private
      Earliest : Nanoseconds := 0;
      --  When the next interrupt is accepted at the earliest.
      Pending  : Event_Count := 0;
      Ignored  : Boolean := False;
   end Gate;

   Accepted : Suspension_Object;
   --  True when an interrupt may have been accepted since the caller of Wait
   --  last looked.

   protected body Gate is
      procedure Note (Now : Nanoseconds; Is_Due : out Boolean) is
      begin
         Is_Due := Now >= Earliest;
         if Is_Due then
            Pending := Next (Pending);
            Earliest :=
              (if Now <= Nanoseconds'Last - Separation then Now + Separation
               else Nanoseconds'Last);
         else
            Ignored := True;
         end if;
      end Note;

      procedure Take (Found, Too_Soon : out Boolean) is
      begin
         Found := Pending > 0;
         Too_Soon := Ignored;
         if Found then
            Pending := Pending - 1;
            Ignored := False;
         end if;
      end Take;
   end Gate;

   procedure Arrive
   with
     Refined_Global =>
       (Input  => (Epochs.Start, Ada.Real_Time.Clock_Time),
        In_Out => (Gate, Accepted))
   is
      Now    : Nanoseconds;
      Is_Due : Boolean;
   begin
      Epochs.Since_Start (Now);
      Gate.Note (Now, Is_Due);
      if Is_Due then
         Set_True (Accepted);
      end if;
   end Arrive;

   procedure Wait (Too_Soon : out Boolean)
   with Refined_Global => (In_Out => (Gate, Accepted))
   is
      Found : Boolean;
   begin
      loop
         Gate.Take (Found, Too_Soon);
         exit when Found;
         Suspend_Until_True (Accepted);
      end loop;
   end Wait;

end Ravenchart.Interrupt_Releases;
