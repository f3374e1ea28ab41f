--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The order in which the driver "ctucanfd" lets its frames leave, on a model
--  of the transmit buffers: by priority where the command line says so.

with Ada.Command_Line;
with Ada.Real_Time;
with Ctu_Driven;
with Ctu_Model;
with Facts;
with Ravenchart;
with Ravenchart.Can;
with Ravenchart.Can.Any_Frames;
with Ravenchart.Can.Transmit_Orders;
with Ravenchart.Epochs;

procedure Test_Ctu_Order is
   use Ravenchart.Can;
   use type Ada.Real_Time.Time;
   use type Ravenchart.Event_Count;

   By_Priority : constant Boolean :=
     Ada.Command_Line.Argument (1) = "priority";

   Base : constant Frame_Format := Ravenchart.Can.Standard;
   --  The literal alone would be hidden by package Standard.

   subtype Message is Positive range 1 .. 4;
   --  A message that the node sends; 1 is the most urgent.

   type Id_List is array (Positive range <>) of Identifier;

   procedure Pause;
   --  A time that is no multiple of the driver's.

   procedure Send (Id : Identifier);
   --  Send a frame, and wait until it is ready in the core.

   procedure Check_Left (Fact : String; Wanted : Id_List);
   --  The frames that wait leave in this order.

   procedure Check_Burst;

   procedure Check_Later;

   procedure Check_Any_Order;

   procedure Check_Counts;

   Waiting : Natural := 0;
   Total   : Ravenchart.Event_Count := 0;

   -----------
   -- Pause --
   -----------

   procedure Pause is
   begin
      delay until Ada.Real_Time.Clock + Ada.Real_Time.Microseconds (317);
   end Pause;

   ----------
   -- Send --
   ----------

   procedure Send (Id : Identifier) is
      Limit  : constant Ada.Real_Time.Time :=
        Ada.Real_Time.Clock + Ada.Real_Time.Seconds (10);
      Status : Send_Status;
   begin
      Ctu_Driven.Controller.Send
        (Any_Frames.To_Any (Data_Frame (Id, Base, 1, 5)), Status);
      Waiting := Waiting + 1;
      Total   := Total + 1;
      while Ctu_Model.Core.Ready < Waiting
        and then Ada.Real_Time.Clock < Limit
      loop
         Pause;
      end loop;
   end Send;

   ----------------
   -- Check_Left --
   ----------------

   procedure Check_Left (Fact : String; Wanted : Id_List) is
      Id   : Identifier;
      Good : Boolean := Waiting = Wanted'Length;
   begin
      for Expected of Wanted loop
         Ctu_Model.Core.Begin_One;
         Ctu_Model.Core.End_One (Id);
         Good := Good and then Id = Expected;
      end loop;
      Waiting := 0;
      Facts.Check (Fact, Good);
   end Check_Left;

   -----------------
   -- Check_Burst --
   -----------------

   procedure Check_Burst is
   begin
      for Id of Id_List'(16#300#, 16#200#, 16#100#, 16#080#) loop
         Send (Id);
      end loop;
      if By_Priority then
         Check_Left
           ("a burst in the worst order leaves by urgency",
            (16#080#, 16#100#, 16#200#, 16#300#));
      else
         Check_Left
           ("a burst leaves in the order sent",
            (16#300#, 16#200#, 16#100#, 16#080#));
      end if;
   end Check_Burst;

   -----------------
   -- Check_Later --
   -----------------

   procedure Check_Later is
      Id : Identifier;
   begin
      Send (16#300#);
      Ctu_Model.Core.Begin_One;
      Send (16#200#);
      Send (16#100#);
      Ctu_Model.Core.End_One (Id);
      Waiting := Waiting - 1;
      Facts.Check ("a frame that has begun is not withdrawn", Id = 16#300#);
      Check_Left
        ("frames that came meanwhile leave in their order",
         (if By_Priority
          then (16#100#, 16#200#) else (16#200#, 16#100#)));
      Send (16#300#);
      Ctu_Model.Core.Begin_One;
      Send (16#100#);
      Ctu_Model.Core.Lose_One;
      Check_Left
        ("a frame that has lost arbitration has its place in the order",
         (if By_Priority
          then (16#100#, 16#300#) else (16#300#, 16#100#)));
   end Check_Later;

   ---------------------
   -- Check_Any_Order --
   ---------------------

   procedure Check_Any_Order is
      Waits : array (Message) of Boolean := (others => False);
      Seed  : Positive := 1;
      Id    : Identifier;
      Good  : Boolean := True;

      function Next return Message;
      --  A number that the seed gives.

      function First return Identifier;
      --  The identifier of the most urgent frame that waits.

      function Next return Message is
      begin
         Seed := (Seed * 75 + 74) mod 65_537 + 1;
         return Seed / 7 mod 4 + 1;
      end Next;

      function First return Identifier is
      begin
         for M in Message loop
            if Waits (M) then
               return Identifier (M);
            end if;
         end loop;
         return 0;
      end First;
   begin
      for Step in 1 .. 500 loop
         declare
            M : constant Message := Next;
         begin
            if not Waits (M) then
               Send (Identifier (M));
               Waits (M) := True;
            else
               Ctu_Model.Core.Begin_One;
               Ctu_Model.Core.End_One (Id);
               Waiting := Waiting - 1;
               Good := Good and then Id = First;
               if Id in 1 .. 4 then
                  Waits (Message (Id)) := False;
               end if;
            end if;
         end;
      end loop;
      Facts.Check
        ("in any order of sending the most urgent frame is next", Good);
      while Waiting > 0 loop
         Ctu_Model.Core.Begin_One;
         Ctu_Model.Core.End_One (Id);
         Waiting := Waiting - 1;
      end loop;
   end Check_Any_Order;

   ------------------
   -- Check_Counts --
   ------------------

   procedure Check_Counts is
      Limit  : constant Ada.Real_Time.Time :=
        Ada.Real_Time.Clock + Ada.Real_Time.Seconds (10);
      Counts : Counters;
   begin
      loop
         Ctu_Driven.Controller.Read_Counters (Counts);
         exit when Counts.Sent = Total or else Ada.Real_Time.Clock > Limit;
         Pause;
      end loop;
      Facts.Check
        ("each frame is counted once",
         Counts.Sent = Total and then Counts.Lost_Out = 0);
      Facts.Check
        ("frames do not wait for the look of the next millisecond",
         Ctu_Model.Core.Prompt > 0);
   end Check_Counts;

   State : Controller_State;
begin
   if By_Priority then
      Transmit_Orders.Set_By_Priority (1);
   end if;
   delay until Ravenchart.Epochs.Start;
   loop
      Ctu_Driven.Controller.Read_State (State);
      exit when State = Error_Active;
      Pause;
   end loop;
   Check_Burst;
   Check_Later;
   if By_Priority then
      Check_Any_Order;
   end if;
   Check_Counts;
   Facts.Finish;
end Test_Ctu_Order;
