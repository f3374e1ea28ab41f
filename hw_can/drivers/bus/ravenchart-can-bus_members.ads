--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The state of a node of a served bus: whether it has joined, its open
--  requests, and its error counters.
--
--  Guarantees   at most Most_Open requests are open, each under a number of
--               its own; each ends as sent or lost. An answer that breaks the
--               protocol ends the connection
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
      Here            : Presence := Away;
      Count           : Open_Count := 0;
      Open            : Number_List := (others => 1);
      Last            : Request_Number := 1;
      Transmit_Errors : Error_Count := 0;
      Receive_Errors  : Error_Count := 0;
   end record
   with Predicate => (if Here = Away then Count = 0);
   --  The first Count numbers of Open are those of the open requests, oldest
   --  first. Last: the number of the latest request.

   function State (M : Member) return Controller_State
   is (if M.Here = Away then Stopped
       else Fault_Confinement.State_For
              (M.Transmit_Errors, M.Receive_Errors))
   with Global => null;
   --  The state that the counters define (ISO 11898-1).

   function Is_Open
     (M : Member; Number : Interfaces.Unsigned_32) return Boolean
   is (for some I in 1 .. M.Count => M.Open (I) = Number)
   with Global => null;
   --  Is the answer to this request still outstanding?

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
       and then M.Transmit_Errors = M.Transmit_Errors'Old
       and then M.Receive_Errors = M.Receive_Errors'Old;
   --  Open a request to send a frame; it gets this number.

   type Consequence is
     (Carry_On, Note_Joined, Note_State, Take_Frame, Count_Sent, Count_Lost,
      End_Connection, Break_Off);
   --  The reaction of a node to an answer. Break_Off: the answer breaks the
   --  protocol, or the server does not accept the node.

   function Consequence_Of (M : Member; A : Answer) return Consequence
   is (if A.Kind = Closed then End_Connection
       elsif M.Here = Away
       then (if A.Kind = Taken_In then Note_Joined else Break_Off)
       else
         (case A.Kind is
            when Frame_Came  => Take_Frame,
            when State_Told  => Note_State,
            when Confirmed   =>
              (if Is_Open (M, A.Number) then Count_Sent else Break_Off),
            when Refused     =>
              (if Is_Open (M, A.Number) then Count_Lost else Break_Off),
            when Noted       => Carry_On,
            when Closed      => End_Connection,
            when Taken_In | Turned_Away | Broken => Break_Off))
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
         (if Then_Do in Count_Sent | Count_Lost
          then M.Count = M.Count'Old - 1
          else M.Count = M.Count'Old and then M.Open = M.Open'Old)
       and then
         (if Then_Do = Note_State
          then M.Transmit_Errors = A.Transmit_Errors
               and then M.Receive_Errors = A.Receive_Errors
          else M.Transmit_Errors = M.Transmit_Errors'Old
               and then M.Receive_Errors = M.Receive_Errors'Old);
   --  The answer A has come from the server.

   procedure Leave (M : in out Member; Lost : out Open_Count)
   with
     Global => null,
     Post   =>
       State (M) = Stopped
       and then M.Count = 0
       and then M.Transmit_Errors = 0
       and then M.Receive_Errors = 0
       and then Lost = M.Count'Old;
   --  The connection has ended: Lost requests were open.

end Ravenchart.Can.Bus_Members;
