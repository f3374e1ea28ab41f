--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The shared objects under test: the profile requires them at library level.

with System;
with Ravenchart.Answered_Offers;
with Ravenchart.Blackboards;
with Ravenchart.Event_Lists;
with Ravenchart.Fault_Reports;
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
with Ravenchart.Value_Buffers;

package Objects is

   Ceiling : constant System.Priority := System.Default_Priority + 5;

   type Job is (First_Job, Second_Job);

   type Signal is (Start, Stop, Reset);

   package Plain is new Ravenchart.Policy_Queues
     (Element_Type => Integer,
      Null_Element => 0);

   package Rejecting is new Ravenchart.Queues
     (Element_Type => Integer,
      Null_Element => -1,
      Capacity     => 3,
      Ceiling      => Ceiling,
      Policy       => Ravenchart.Queueing.Reject_Newest);

   package Dropping is new Ravenchart.Queues
     (Element_Type => Integer,
      Null_Element => -1,
      Capacity     => 3,
      Ceiling      => Ceiling,
      Policy       => Ravenchart.Queueing.Drop_Oldest);

   package Board is new Ravenchart.Blackboards
     (Element_Type => Integer,
      Initial      => 42,
      Ceiling      => Ceiling);

   package Ports is new Ravenchart.Port_Regions
     (Value_Type => Integer,
      Default    => 7);

   package Events is new Ravenchart.Event_Lists
     (Event      => Signal,
      Null_Event => Start,
      Capacity   => 3);

   package Counters is new Ravenchart.Health_Counters
     (Ceiling => Ceiling);

   Call_Limit : constant := 3;
   --  Executions for which a call of another node waits.

   package Calling is new Ravenchart.Remote_Calls
     (Limit   => Call_Limit,
      Ceiling => Ceiling);

   package Reading is new Ravenchart.Remote_Reads
     (Element_Type => Integer,
      Initial      => -1,
      Limit        => Call_Limit,
      Ceiling      => Ceiling);

   package Trace is new Ravenchart.Trace_Buffers
     (Capacity => 4,
      Ceiling  => Ceiling);

   package Faults is new Ravenchart.Fault_Reports
     (Record_Fault => Counters.Record_Fault,
      Note         => Trace.Note);

   package Rejecting_Offers is new Ravenchart.Offers
     (Element_Type => Integer,
      Put          => Rejecting.Put,
      Policy       => Ravenchart.Queueing.Reject_Newest,
      Element      => 1,
      Report       => Faults.Report);

   package Dropping_Offers is new Ravenchart.Offers
     (Element_Type => Integer,
      Put          => Dropping.Put,
      Policy       => Ravenchart.Queueing.Drop_Oldest,
      Element      => 2,
      Report       => Faults.Report);

   procedure Answer;
   --  Offers 99 to the queue with policy Drop_Oldest.

   package Answered is new Ravenchart.Answered_Offers
     (Offers  => Rejecting_Offers,
      On_Loss => Answer);

   package Large_Trace is new Ravenchart.Trace_Buffers
     (Capacity => 65_536,
      Ceiling  => Ceiling);

   package Values is new Ravenchart.Value_Buffers
     (Capacity => 4,
      Ceiling  => Ceiling);

   package Monitor is new Ravenchart.Monitors
     (Activity_Id => Job,
      Ceiling     => Ceiling);

end Objects;
