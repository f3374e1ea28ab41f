--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ravenchart.Queues;

package body Ravenchart.Value_Buffers
  with SPARK_Mode, Refined_State => (State => Records.State)
is
   package Records is new Queues
     (Element_Type => Recorded_Values.Value_Record,
      Null_Element => Recorded_Values.Null_Record,
      Capacity     => Capacity,
      Ceiling      => Ceiling,
      Policy       => Queueing.Reject_Newest);

   procedure Note (Value : Number; Element : Element_Id)
   with
     Refined_Global =>
       (Input  => (Epochs.Start, Ada.Real_Time.Clock_Time),
        In_Out => Records.State)
   is
      Now    : Nanoseconds;
      Status : Queueing.Put_Status;
   begin
      Epochs.Since_Start (Now);
      pragma Warnings
        (GNATprove, Off, """Status"" is set by*",
         Reason => "the queue counts what it rejects");
      Records.Put ((Now, Element, Value), Status);
      pragma Warnings (GNATprove, On, """Status"" is set by*");
   end Note;

   procedure Take
     (Item   : out Recorded_Values.Value_Record;
      Status : out Queueing.Take_Status)
   renames Records.Take;

   function Lost return Event_Count
   renames Records.Lost;

end Ravenchart.Value_Buffers;
