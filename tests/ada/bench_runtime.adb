--  What the runtime's operations cost: each beside the same work without the
--  protected object, in one run. Prints nanoseconds per operation, the median
--  of several rounds. The locking policy is that of the Ravenscar profile
--  (Ceiling_Locking): as root each protected call changes the task's priority
--  twice through the kernel, as an ordinary user it does not.

with Ada.Real_Time;
with Ada.Text_IO;
with GNAT.OS_Lib;
with System;
with Objects;
with Ravenchart.Queueing;

procedure Bench_Runtime
  with Priority => System.Default_Priority
is
   use type Ada.Real_Time.Time;

   Rounds     : constant := 9;
   Operations : constant := 20_000;

   type Figures is array (1 .. Rounds) of Natural;

   generic
      with procedure Operation (Value : Integer);
   procedure Measure (Name : String);

   procedure Measure (Name : String) is
      Found : Figures;
      Start : Ada.Real_Time.Time;
      Spent : Duration;
   begin
      for Round in Found'Range loop
         Start := Ada.Real_Time.Clock;
         for Value in 1 .. Operations loop
            Operation (Value);
         end loop;
         Spent := Ada.Real_Time.To_Duration (Ada.Real_Time.Clock - Start);
         Found (Round) := Natural (Spent * 1_000_000_000 / Operations);
         for Place in reverse 2 .. Round loop
            exit when Found (Place - 1) <= Found (Place);
            Start_Swap :
            declare
               Held : constant Natural := Found (Place);
            begin
               Found (Place)     := Found (Place - 1);
               Found (Place - 1) := Held;
            end Start_Swap;
         end loop;
      end loop;
      Ada.Text_IO.Put_Line
        (Name & Natural'Image (Found (Rounds / 2 + 1)) & " ns");
   end Measure;

   Plain_Store : Objects.Fifos.Fifo (16);
   Plain_Value : Integer := 0 with Volatile;

   procedure Plain_Queue (Value : Integer) is
      Taken : Integer;
   begin
      Objects.Fifos.Put (Plain_Store, Value);
      Objects.Fifos.Get (Plain_Store, Taken);
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

   procedure Copy is new Measure (Plain_Copy);
   procedure Board is new Measure (Board_Both);
   procedure Fifo is new Measure (Plain_Queue);
   procedure Queue is new Measure (Queue_Both);
begin
   Copy ("plain variable, write:");
   Board ("blackboard, write and read:");
   Fifo ("fifo without lock, put and get:");
   Queue ("queue, put and take:");
   GNAT.OS_Lib.OS_Exit (0);
   --  under this profile the environment task never ends by itself
end Bench_Runtime;
