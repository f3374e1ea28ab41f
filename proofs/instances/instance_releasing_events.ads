--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  One representative instance of the event queue that releases a processor.

with Ravenchart.Queueing;
with Ravenchart.Releasing_Events;

package Instance_Releasing_Events
  with SPARK_Mode
is
   type Event is record
      Name  : Natural := 0;
      Value : Ravenchart.Number := 0;
   end record;
   --  Represents the events of a component.

   No_Event : constant Event := (others => <>);

   package Queue is new Ravenchart.Releasing_Events
     (Element_Type => Event,
      Null_Element => No_Event,
      Capacity     => 4,
      Ceiling      => 10,
      Policy       => Ravenchart.Queueing.Reject_Newest);

end Instance_Releasing_Events;
