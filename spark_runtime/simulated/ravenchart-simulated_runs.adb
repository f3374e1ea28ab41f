--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Text_IO;
with Ravenchart.Steps;

procedure Ravenchart.Simulated_Runs is
   Next   : Instants := Offsets;
   Counts : array (Processor) of Natural := (others => 0);
   Last  : Long_Long_Integer;
   Coming : Long_Long_Integer := Long_Long_Integer'Last;
   Number : Long_Long_Integer;
   First  : Processor;
   Now    : Long_Long_Integer;

   procedure Look_Ahead;
   --  The instant of the next stimulus, if there is one.

   procedure Look_Ahead is
   begin
      Ada.Text_IO.Skip_Line;
      Coming := Long_Long_Integer'Last;
      if not Ada.Text_IO.End_Of_File then
         Steps.Get (Coming);
      end if;
   end Look_Ahead;

begin
   Steps.Get (Last);
   Look_Ahead;
   loop
      First := Processor'First;
      for P in Processor loop
         if Next (P) < Next (First) then
            First := P;
         end if;
      end loop;
      exit when Next (First) > Last;
      Now := Next (First);
      Steps.Set_Time (Now);
      while Coming <= Now loop
         Steps.Get (Number);
         Take (Positive (Number));
         Look_Ahead;
      end loop;
      Release (First, Counts (First));
      Next (First)   := Now + Periods (First);
      Counts (First) := Counts (First) + 1;
      if (for all P in Processor => Next (P) /= Now) then
         End_Instant;
      end if;
   end loop;
end Ravenchart.Simulated_Runs;
