package body Ravenchart.Can.Bus_Members
  with SPARK_Mode
is

   procedure Settle (M : in out Member; Number : Interfaces.Unsigned_32)
   with
     Global => null,
     Pre    => Is_Open (M, Number),
     Post   =>
       M.Count = M.Count'Old - 1
       and then M.Here = M.Here'Old
       and then M.Last = M.Last'Old
       and then M.Counts = M.Counts'Old;
   --  The request of this number is open no more; the others keep their
   --  order.

   ---------
   -- Ask --
   ---------

   procedure Ask (M : in out Member; Number : out Request_Number) is
   begin
      Number           := Number_After (M.Last);
      M.Last           := Number;
      M.Count          := M.Count + 1;
      M.Open (M.Count) := Number;
   end Ask;

   ----------------
   -- Count_Lost --
   ----------------

   procedure Count_Lost (M : in out Member) is
   begin
      M.Counts.Lost_Out := Next (M.Counts.Lost_Out);
   end Count_Lost;

   --------------------
   -- Count_Received --
   --------------------

   procedure Count_Received (M : in out Member) is
   begin
      M.Counts.Received := Next (M.Counts.Received);
   end Count_Received;

   ------------
   -- Settle --
   ------------

   procedure Settle (M : in out Member; Number : Interfaces.Unsigned_32) is
      Place : Positive range 1 .. Most_Open := 1;
   begin
      while M.Open (Place) /= Number loop
         pragma Loop_Invariant (Place < M.Count);
         pragma Loop_Invariant
           (for some I in Place + 1 .. M.Count => M.Open (I) = Number);
         Place := Place + 1;
      end loop;
      for I in Place .. M.Count - 1 loop
         M.Open (I) := M.Open (I + 1);
      end loop;
      M.Count := M.Count - 1;
   end Settle;

   ----------
   -- Hear --
   ----------

   procedure Hear
     (M : in out Member; A : Answer; Then_Do : out Consequence) is
   begin
      Then_Do := Consequence_Of (M, A);
      case Then_Do is
         when Note_Joined    =>
            M.Here := Joined;
         when End_Connection =>
            if A.Kind /= Closed then
               M.Counts.Rejected_Lines := Next (M.Counts.Rejected_Lines);
            end if;
         when Carry_On | Take_Frame | Ask_Recovery =>
            case A.Kind is
               when State_Told =>
                  M.Counts.Transmit_Errors := A.Transmit_Errors;
                  M.Counts.Receive_Errors  := A.Receive_Errors;
               when Confirmed  =>
                  Settle (M, A.Number);
                  M.Counts.Sent := Next (M.Counts.Sent);
               when Refused    =>
                  Settle (M, A.Number);
                  M.Counts.Lost_Out := Next (M.Counts.Lost_Out);
               when others     =>
                  null;
            end case;
      end case;
   end Hear;

   -----------
   -- Leave --
   -----------

   procedure Leave (M : in out Member) is
   begin
      M.Counts.Lost_Out :=
        Sum (M.Counts.Lost_Out, Event_Count (M.Count));
      M.Counts.Transmit_Errors := 0;
      M.Counts.Receive_Errors  := 0;
      M.Count := 0;
      M.Here  := Away;
   end Leave;

end Ravenchart.Can.Bus_Members;
