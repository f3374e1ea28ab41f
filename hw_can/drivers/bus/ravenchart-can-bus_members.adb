--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

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
       and then M.Transmit_Errors = M.Transmit_Errors'Old
       and then M.Receive_Errors = M.Receive_Errors'Old;
   --  Remove the request with this number; the others keep their order.

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
         when Note_Joined             =>
            M.Here := Joined;
         when Note_State              =>
            M.Transmit_Errors := A.Transmit_Errors;
            M.Receive_Errors  := A.Receive_Errors;
         when Count_Sent | Count_Lost =>
            Settle (M, A.Number);
         when Carry_On | Take_Frame | End_Connection | Break_Off =>
            null;
      end case;
   end Hear;

   -----------
   -- Leave --
   -----------

   procedure Leave (M : in out Member; Lost : out Open_Count) is
   begin
      Lost := M.Count;
      M.Count           := 0;
      M.Here            := Away;
      M.Transmit_Errors := 0;
      M.Receive_Errors  := 0;
   end Leave;

end Ravenchart.Can.Bus_Members;
