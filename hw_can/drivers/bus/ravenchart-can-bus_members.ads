--  A node of a served bus, as it knows itself: whether it has joined, which
--  of its requests are open, and what was counted.
--
--  Guarantees   at most Most_Open requests are open, each under a number of
--               its own; each ends as sent or lost, and what a server must
--               not say ends the connection
--  Tasking      none: one owner for each Member
--  Timing       constant

with Interfaces;
with Ravenchart.Can.Bus_Records.Client_Side;
with Ravenchart.Can.Fault_Confinement;

package Ravenchart.Can.Bus_Members
  with SPARK_Mode, Pure
is
   use Bus_Records.Client_Side;
   use type Interfaces.Unsigned_32;

   Most_Open : constant := 8;
   --  Enough to keep a bus of 1 Mbit/s busy while an answer is on its way.

   subtype Open_Count is Natural range 0 .. Most_Open;

   subtype Request_Number is
     Interfaces.Unsigned_32 range 1 .. Interfaces.Unsigned_32'Last;

   type Number_List is array (Positive range 1 .. Most_Open)
     of Request_Number;

   type Presence is (Away, Joined);

   type Member is record
      Here   : Presence := Away;
      Count  : Open_Count := 0;
      Open   : Number_List := (others => 1);
      Last   : Request_Number := 1;
      Counts : Counters;
   end record
   with Predicate => (if Here = Away then Count = 0);
   --  The first Count numbers of Open are those of requests that are open,
   --  the oldest first. Last: the number of the latest request.

   function State (M : Member) return Controller_State
   is (if M.Here = Away then Stopped
       else Fault_Confinement.State_For
              (M.Counts.Transmit_Errors, M.Counts.Receive_Errors))
   with Global => null;
   --  As its counters say (ISO 11898-1).

   function Is_Open
     (M : Member; Number : Interfaces.Unsigned_32) return Boolean
   is (for some I in 1 .. M.Count => M.Open (I) = Number)
   with Global => null;
   --  Is an answer to this request still to come?

   function Number_After (Number : Request_Number) return Request_Number
   is (if Number = Request_Number'Last then 1 else Number + 1)
   with Global => null;

   function May_Ask (M : Member) return Boolean
   is (State (M) in Error_Active | Error_Passive
       and then M.Count < Most_Open
       and then not Is_Open (M, Number_After (M.Last)))
   with Global => null;
   --  Can a frame be sent now?

   procedure Ask (M : in out Member; Number : out Request_Number)
   with
     Global => null,
     Pre    => May_Ask (M),
     Post   =>
       Number = Number_After (M.Last'Old)
       and then M.Last = Number
       and then M.Count = M.Count'Old + 1
       and then M.Open (M.Count) = Number
       and then
         (for all I in 1 .. M.Count - 1 => M.Open (I) = M.Open'Old (I))
       and then M.Here = M.Here'Old
       and then M.Counts = M.Counts'Old;
   --  A frame is to be sent, as the request of this number.

   function Sum (A, B : Event_Count) return Event_Count
   is (if A > Event_Count'Last - B then Event_Count'Last else A + B)
   with Global => null;
   --  Both together, and no more than the last value.

   procedure Count_Lost (M : in out Member)
   with
     Global => null,
     Post   =>
       M.Counts.Lost_Out = Next (M.Counts.Lost_Out'Old)
       and then M.Here = M.Here'Old
       and then M.Count = M.Count'Old
       and then M.Open = M.Open'Old;
   --  A frame was given up before it was asked for.

   procedure Count_Received (M : in out Member)
   with
     Global => null,
     Post   =>
       M.Counts.Received = Next (M.Counts.Received'Old)
       and then M.Here = M.Here'Old
       and then M.Count = M.Count'Old
       and then M.Open = M.Open'Old;
   --  A frame was accepted.

   type Consequence is
     (Carry_On, Note_Joined, Take_Frame, Ask_Recovery, End_Connection);
   --  What a node does about what it has heard.

   function Consequence_Of (M : Member; A : Answer) return Consequence
   is (if M.Here = Away
       then (if A.Kind = Taken_In then Note_Joined else End_Connection)
       else
         (case A.Kind is
            when Frame_Came                               => Take_Frame,
            when State_Told                               =>
              (if Fault_Confinement.State_For
                    (A.Transmit_Errors, A.Receive_Errors) = Bus_Off
               then Ask_Recovery
               else Carry_On),
            when Confirmed | Refused                      =>
              (if Is_Open (M, A.Number) then Carry_On
               else End_Connection),
            when Noted                                    => Carry_On,
            when Taken_In | Closed | Turned_Away | Broken =>
              End_Connection))
   with Global => null;
   --  A welcome comes first and once; only open requests are answered.

   procedure Hear
     (M : in out Member; A : Answer; Then_Do : out Consequence)
   with
     Global => null,
     Post   =>
       Then_Do = Consequence_Of (M'Old, A)
       and then M.Last = M.Last'Old
       and then M.Here =
         (if Then_Do = Note_Joined then Joined else M.Here'Old)
       and then
         (if Then_Do = Carry_On and then A.Kind in Confirmed | Refused
          then M.Count = M.Count'Old - 1
          else M.Count = M.Count'Old and then M.Open = M.Open'Old)
       and then M.Counts.Sent =
         (if Then_Do = Carry_On and then A.Kind = Confirmed
          then Next (M.Counts.Sent'Old) else M.Counts.Sent'Old)
       and then M.Counts.Lost_Out =
         (if Then_Do = Carry_On and then A.Kind = Refused
          then Next (M.Counts.Lost_Out'Old) else M.Counts.Lost_Out'Old)
       and then M.Counts.Rejected_Lines =
         (if Then_Do = End_Connection and then A.Kind /= Closed
          then Next (M.Counts.Rejected_Lines'Old)
          else M.Counts.Rejected_Lines'Old)
       and then
         (if Then_Do /= End_Connection and then A.Kind = State_Told
          then M.Counts.Transmit_Errors = A.Transmit_Errors
               and then M.Counts.Receive_Errors = A.Receive_Errors
          else M.Counts.Transmit_Errors = M.Counts.Transmit_Errors'Old
               and then
                 M.Counts.Receive_Errors = M.Counts.Receive_Errors'Old);
   --  The server has said A.

   procedure Leave (M : in out Member)
   with
     Global => null,
     Post   =>
       State (M) = Stopped
       and then M.Count = 0
       and then M.Counts.Lost_Out =
         Sum (M.Counts.Lost_Out'Old, Event_Count (M.Count'Old))
       and then M.Counts.Sent = M.Counts.Sent'Old;
   --  The connection is gone, and with it what was asked for.

end Ravenchart.Can.Bus_Members;
