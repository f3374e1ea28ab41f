--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Execution times of the runtime's operations: each beside the same work
--  without the protected object, in one run. Prints nanoseconds per operation,
--  the median of several rounds. The locking policy is that of the Ravenscar
--  profile (Ceiling_Locking): as root each protected call changes the task's
--  priority twice through the kernel, as an ordinary user it does not.

with GNAT.OS_Lib;
with System;
with Measuring;
with Objects;
with Ravenchart.Queueing;

procedure Bench_Runtime
  with Priority => System.Default_Priority
is
   Plain_Store : Objects.Plain.Queue (16);
   Plain_Value : Integer := 0 with Volatile;

   procedure Plain_Queue (Value : Integer) is
      Put   : Ravenchart.Queueing.Put_Status;
      Take  : Ravenchart.Queueing.Take_Status;
      Taken : Integer;
   begin
      Objects.Plain.Put
        (Plain_Store, Value, Ravenchart.Queueing.Reject_Newest, Put);
      Objects.Plain.Take (Plain_Store, Taken, Take);
      Plain_Value := Taken;
   end Plain_Queue;

   procedure Plain_Copy (Value : Integer) is
   begin
      Plain_Value := Value;
   end Plain_Copy;

   procedure Queue_Both (Value : Integer) is
      Put   : Ravenchart.Queueing.Put_Status;
      Take  : Ravenchart.Queueing.Take_Status;
      Taken : Integer;
   begin
      Objects.Rejecting.Put (Value, Put);
      Objects.Rejecting.Take (Taken, Take);
      Plain_Value := Taken;
   end Queue_Both;

   procedure Board_Both (Value : Integer) is
      Seen : Integer;
   begin
      Objects.Board.Write (Value);
      Objects.Board.Read (Seen);
      Plain_Value := Seen;
   end Board_Both;

   procedure Copy is new Measuring.Measure (Plain_Copy);
   procedure Board is new Measuring.Measure (Board_Both);
   procedure Value is new Measuring.Measure (Plain_Queue);
   procedure Queue is new Measuring.Measure (Queue_Both);
begin
   Copy ("plain variable, write:");
   Board ("blackboard, write and read:");
   Value ("queue without lock, put and take:");
   Queue ("queue, put and take:");
   GNAT.OS_Lib.OS_Exit (0);
   --  under this profile the environment task never ends by itself
end Bench_Runtime;
