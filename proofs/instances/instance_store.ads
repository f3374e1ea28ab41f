--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Provers see only instances: one representative instance of each generic
--  that has no task.

with System;
with Ravenchart.Answered_Offers;
with Ravenchart.Blackboards;
with Ravenchart.Crossing_Boards;
with Ravenchart.Crossing_Queues;
with Ravenchart.Crossing_Samples;
with Ravenchart.Deferrals;
with Ravenchart.Event_Lists;
with Ravenchart.Fault_Reports;
with Ravenchart.Firing_Lists;
with Ravenchart.Health_Counters;
with Ravenchart.Monitors;
with Ravenchart.Offers;
with Ravenchart.Policy_Queues;
with Ravenchart.Port_Regions;
with Ravenchart.Queueing;
with Ravenchart.Queues;
with Ravenchart.Remote_Calls;
with Ravenchart.Remote_Reads;
with Ravenchart.Trace_Buffers;

package Instance_Store
  with SPARK_Mode
is
   Ceiling : constant System.Priority := System.Default_Priority + 7;
   --  The ceiling of every object here.

   type Reading is record
      Level : Ravenchart.Number := 0;
      Valid : Boolean := False;
   end record;
   --  Represents a type of a model.

   No_Reading : constant Reading := (others => <>);

   type Signal is (Start, Stop, Reset);
   --  Represents the events of a region.

   type Job is (Sense, Control, Report);
   --  Represents the activities of a processor.

   package Values is new Ravenchart.Policy_Queues
     (Element_Type => Reading,
      Null_Element => No_Reading);

   package Rejecting_Queue is new Ravenchart.Queues
     (Element_Type => Reading,
      Null_Element => No_Reading,
      Capacity     => 4,
      Ceiling      => Ceiling,
      Policy       => Ravenchart.Queueing.Reject_Newest);

   package Dropping_Queue is new Ravenchart.Queues
     (Element_Type => Signal,
      Null_Element => Signal'First,
      Capacity     => 4,
      Ceiling      => Ceiling,
      Policy       => Ravenchart.Queueing.Drop_Oldest);

   package Board is new Ravenchart.Blackboards
     (Element_Type => Reading,
      Initial      => No_Reading,
      Ceiling      => Ceiling);

   package Crossing_Board is new Ravenchart.Crossing_Boards
     (Element_Type => Reading,
      Initial      => No_Reading);

   package Crossing_Sample is new Ravenchart.Crossing_Samples
     (Element_Type => Reading,
      Null_Element => No_Reading);

   package Crossing_Queue is new Ravenchart.Crossing_Queues
     (Element_Type => Reading,
      Null_Element => No_Reading,
      Capacity     => 4);

   package Ports is new Ravenchart.Port_Regions
     (Value_Type => Reading,
      Default    => No_Reading);

   package Events is new Ravenchart.Event_Lists
     (Event      => Signal,
      Null_Event => Start,
      Capacity   => 3);

   type Place is (Busy, Idle);
   --  Represents the configuration of a region.

   type Left is (Nothing_Left, All_Left);
   --  Represents the domains of transitions.

   function Name_Of (Item : Signal) return Signal is (Item);

   function Is_Deferred (Name : Signal; Here : Place) return Boolean is
     (Name /= Reset and then Here = Busy);

   function Is_Freed
     (Name : Signal; D : Left; Here : Place) return Boolean is
     (Name = Stop and then D = All_Left and then Here = Busy);

   package Deferred is new Ravenchart.Deferrals
     (Event         => Signal,
      Null_Event    => Start,
      Event_Name    => Signal,
      Name_Of       => Name_Of,
      Capacity      => 3,
      Configuration => Place,
      Is_Deferred   => Is_Deferred,
      Domain        => Left,
      Is_Freed      => Is_Freed);

   type Way is (None, First_Way, Second_Way, Segment);
   --  Represents the transitions of a region and their segments.

   function Is_Segment (T : Way) return Boolean is (T = Segment);

   package Firings is new Ravenchart.Firing_Lists
     (Selection     => Way,
      No_Selection  => None,
      Is_Segment    => Is_Segment,
      Most_Segments => 1,
      Capacity      => 4);

   package Counters is new Ravenchart.Health_Counters
     (Ceiling => Ceiling);

   package Calling is new Ravenchart.Remote_Calls
     (Limit   => 3,
      Ceiling => Ceiling);

   package Copied is new Ravenchart.Remote_Reads
     (Element_Type => Reading,
      Initial      => No_Reading,
      Limit        => 3,
      Ceiling      => Ceiling);

   package Trace is new Ravenchart.Trace_Buffers
     (Capacity => 64,
      Ceiling  => Ceiling);

   package Faults is new Ravenchart.Fault_Reports
     (Record_Fault => Counters.Record_Fault,
      Note         => Trace.Note);

   package Dropping_Offers is new Ravenchart.Offers
     (Element_Type => Signal,
      Put          => Dropping_Queue.Put,
      Policy       => Ravenchart.Queueing.Drop_Oldest,
      Element      => 1,
      Report       => Faults.Report);

   procedure Answer;
   --  Represents the reaction of a model to a loss.

   package Dropping_Answered_Offers is new Ravenchart.Answered_Offers
     (Offers  => Dropping_Offers,
      On_Loss => Answer);

   package Observed is new Ravenchart.Monitors
     (Activity_Id => Job,
      Ceiling     => Ceiling);

end Instance_Store;
