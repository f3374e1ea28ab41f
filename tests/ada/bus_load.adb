--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Messages on the simulated bus, at full load and with disturbed bits: the
--  worst response of each.
--
--  Standard input: "order bit seed separation until", order 1 for buffers by
--  priority, times in ns, separation 0 for no errors; then for each message
--  "node identifier length offset period jitter". Standard output: "worst
--  identifier ns" for each, and "ended errors passive".

with Ada.Text_IO;
with Interfaces;
with Ravenchart.Can;
with Ravenchart.Can.Bus_Faults;
with Ravenchart.Can.Bus_Frames;
with Ravenchart.Can.Bus_Nodes;
with Ravenchart.Can.Buses;
with Ravenchart.Can.Fault_Confinement;
with Ravenchart.Can.Fault_Plans;
with Ravenchart.Can.Networks;
with Ravenchart.Can.Transmit_Buffers;
with Simulated;

procedure Bus_Load is
   use Ravenchart;
   use Ravenchart.Can;
   use Simulated;
   use type Buses.Ending;
   use type Interfaces.Unsigned_32;

   package Times is new Ada.Text_IO.Integer_IO (Nanoseconds);

   Most : constant := 64;

   type Message is record
      Node   : Bus_Nodes.Node_Index := 1;
      Frame  : Bus_Frames.Bus_Frame;
      Offset : Nanoseconds := 0;
      Period : Positive_Nanoseconds := 1;
      Jitter : Nanoseconds := 0;
      Count  : Nanoseconds := 0;
      Queued : Nanoseconds := 0;
      Worst  : Nanoseconds := 0;
   end record;
   --  Count: its releases so far. Queued: the time at which the next one is
   --  queued.

   Messages : array (1 .. Most) of Message;
   Last     : Natural := 0;
   Plan     : Fault_Plans.Plan;
   Chance   : Interfaces.Unsigned_32 := 1;
   Horizon  : Nanoseconds;
   Errors   : Natural := 0;
   Passive  : Boolean := False;

   function Next_Number return Nanoseconds;
   --  The next number of standard input.

   procedure Read;
   --  Read the messages.

   procedure Prepare (M : in out Message);
   --  Set the time at which its next release is queued.

   procedure Release (I : Positive);
   --  Queue a release of message I.

   procedure Carry (M : Networks.Moment);
   --  Carry out what begins on the bus then.

   -----------------
   -- Next_Number --
   -----------------

   function Next_Number return Nanoseconds is
      Result : Nanoseconds;
   begin
      Times.Get (Result);
      return Result;
   end Next_Number;

   ----------
   -- Read --
   ----------

   procedure Read is
      By_Priority : constant Boolean := Next_Number = 1;
   begin
      Start (8);
      for I in Bus_Nodes.Node_Index range 1 .. 8 loop
         Transmit_Buffers.Reset
           (Net.Buffers (I),
            (if By_Priority then Transmit_Buffers.By_Priority
             else Transmit_Buffers.First_In_First_Out));
      end loop;
      Net.Bus.Times.Nominal := Next_Number;
      Plan.Seed := Interfaces.Unsigned_32 (Next_Number);
      Plan.Separation := Next_Number;
      Horizon := Next_Number;
      while not Ada.Text_IO.End_Of_File loop
         Last := Last + 1;
         Messages (Last).Node := Bus_Nodes.Node_Index (Next_Number);
         declare
            Id : constant Identifier := Identifier (Next_Number);
         begin
            Messages (Last).Frame :=
              (Family => Bus_Frames.Classic,
               Plain  => Data_Frame
                 (Id, Ravenchart.Can.Standard, Natural (Next_Number), 0));
         end;
         Messages (Last).Offset := Next_Number;
         Messages (Last).Period := Next_Number;
         Messages (Last).Jitter := Next_Number;
         Prepare (Messages (Last));
         Ada.Text_IO.Skip_Line;
      end loop;
   end Read;

   -------------
   -- Prepare --
   -------------

   procedure Prepare (M : in out Message) is
   begin
      Chance := Fault_Plans.Next (Chance);
      M.Queued := M.Offset + M.Count * M.Period
        + M.Jitter * Nanoseconds (Interfaces.Shift_Right (Chance, 24)) / 255;
   end Prepare;

   -------------
   -- Release --
   -------------

   procedure Release (I : Positive) is
      M      : Message renames Messages (I);
      Status : Send_Status;
   begin
      Networks.Submit
        (Net, M.Node,
         (Frame => M.Frame,
          Tag   => Interfaces.Unsigned_32 (I)
                   + Most * 2 * Interfaces.Unsigned_32 (M.Count),
          Since => M.Queued),
         Status);
      if Status = Rejected_Full then
         raise Program_Error with "more load than the bus can carry";
      end if;
      M.Count := M.Count + 1;
      Prepare (M);
   end Release;

   -----------
   -- Carry --
   -----------

   procedure Carry (M : Networks.Moment) is
      Fault : Bus_Faults.Fault;
   begin
      Fault_Plans.Draw (Plan, M.Start, Fault);
      Networks.Step (Net, M, Fault, Result, Receipts);
      if Result.Ended = Buses.Broken then
         Errors := Errors + 1;
         Fault_Plans.Note (Plan, Result.Struck);
      end if;
      for N in Bus_Nodes.Node_Index range 1 .. 8 loop
         if Result.Sent (N) then
            declare
               Tag   : constant Interfaces.Unsigned_32 := Receipts (N).Tag;
               Which : Message renames
                 Messages (Positive (Tag mod (Most * 2)));
               Event : constant Nanoseconds :=
                 Which.Offset
                 + Nanoseconds (Tag / (Most * 2)) * Which.Period;
            begin
               Which.Worst := Nanoseconds'Max
                 (Which.Worst, Net.Bus.Free_At (1) - Event);
            end;
         end if;
         Passive := Passive
           or else
             Fault_Confinement.State (Net.Bus.Nodes (N).Confinement)
             /= Error_Active;
      end loop;
   end Carry;

   Moment : Networks.Moment;
   First  : Positive;
begin
   Read;
   loop
      First := 1;
      for I in 2 .. Last loop
         if Messages (I).Queued < Messages (First).Queued then
            First := I;
         end if;
      end loop;
      Moment := Networks.Next (Net);
      exit when Messages (First).Queued > Horizon;
      if Moment.Known and then Moment.Start < Messages (First).Queued then
         Carry (Moment);
      else
         Release (First);
      end if;
   end loop;
   for M of Messages (1 .. Last) loop
      Ada.Text_IO.Put_Line
        ("worst" & M.Frame.Plain.Id'Image & M.Worst'Image);
   end loop;
   Ada.Text_IO.Put_Line
     ("ended" & Errors'Image & (if Passive then " 1" else " 0"));
end Bus_Load;
