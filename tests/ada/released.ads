--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A processor that the mailbox of a port releases, and the record of its
--  releases.

with System;
with Ada.Real_Time;
with Ravenchart.Queueing;
with Ravenchart.Releasing_Queues;
with Ravenchart.Sporadic_Processors;

package Released is

   Separation : constant := 50_000;
   --  The separation of two releases in ns.

   type Row is (Handle);

   procedure Run (Item : Row);
   --  Take the oldest value, and compare it with the number of this release.

   procedure Ignore_Miss is null;

   package Mailbox is new Ravenchart.Releasing_Queues
     (Element_Type => Natural,
      Null_Element => 0,
      Capacity     => 8,
      Ceiling      => System.Default_Priority + 6,
      Policy       => Ravenchart.Queueing.Reject_Newest);

   package Newest is new Ravenchart.Releasing_Queues
     (Element_Type => Natural,
      Null_Element => 0,
      Capacity     => 2,
      Ceiling      => System.Default_Priority + 6,
      Policy       => Ravenchart.Queueing.Drop_Oldest);
   --  A queue that releases no processor.

   package Processor is new Ravenchart.Sporadic_Processors
     (Name               => "released",
      Activity_Id        => Row,
      Minimum_Separation => Separation,
      Deadline           => Separation,
      Task_Priority      => System.Default_Priority + 5,
      Ceiling            => System.Default_Priority + 5,
      Stack_Bytes        => 65_536,
      Wait               => Mailbox.Wait,
      Execute            => Run,
      On_Deadline_Miss   => Ignore_Miss);

   protected Log
     with Priority => System.Default_Priority + 6
   is
      procedure Add (Value : Natural; Taken : Boolean);

      function Handled return Natural;

      function In_Order return Boolean;
      --  Has each release found the value of its number?

      function Last_At return Ada.Real_Time.Time;
      --  The time at which the last one was handled.

   private
      Count   : Natural := 0;
      Orderly : Boolean := True;
      Latest  : Ada.Real_Time.Time := Ada.Real_Time.Time_First;
   end Log;

end Released;
