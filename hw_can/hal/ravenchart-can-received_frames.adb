--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Waiting_Queues;

package body Ravenchart.Can.Received_Frames
  with
    SPARK_Mode,
    Refined_State => (State => Stamped.State, Wake_Up => Stamped.Wake_Up)
is
   type Stamped_Frame is record
      Item  : Any_Frames.Any_Frame;
      Stamp : Nanoseconds := 0;
   end record;

   package Stamped is new Waiting_Queues
     (Element_Type => Stamped_Frame,
      Null_Element => (Item => Any_Frames.Null_Any_Frame, Stamp => 0),
      Capacity     => Capacity,
      Ceiling      => Ceiling);

   procedure Put (F : Any_Frames.Any_Frame)
   with
     Refined_Global =>
       (In_Out => (Stamped.State, Stamped.Wake_Up),
        Input  => (Epochs.Start, Ada.Real_Time.Clock_Time))
   is
      Now    : Nanoseconds;
      Status : Queueing.Put_Status;
   begin
      Epochs.Since_Start (Now);
      pragma Warnings
        (GNATprove, Off, """Status"" is set by*",
         Reason => "the queue counts what it rejects");
      Stamped.Put ((Item => F, Stamp => Now), Status);
      pragma Warnings (GNATprove, On, """Status"" is set by*");
   end Put;

   procedure Wait
     (F : out Any_Frames.Any_Frame; Stamp : out Nanoseconds)
   with
     Refined_Global => (In_Out => (Stamped.State, Stamped.Wake_Up))
   is
      Next : Stamped_Frame;
   begin
      Stamped.Wait (Next);
      F     := Next.Item;
      Stamp := Next.Stamp;
   end Wait;

   function Lost return Event_Count
   with Refined_Global => Stamped.State
   is
   begin
      return Stamped.Lost;
   end Lost;

end Ravenchart.Can.Received_Frames;
