--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The log of a controller's faults, and the notices of it: every sequence of
--  states up to a length, with looks after any of them, against a separate
--  count.

with Facts;
with Ravenchart;
with Ravenchart.Can;
with Ravenchart.Can.Fault_Notices;

procedure Test_Fault_Notices is
   use Ravenchart.Can;
   use Ravenchart.Can.Fault_Notices;
   use type Ravenchart.Event_Count;
   use type Ravenchart.Execution_Count;

   Length : constant := 6;
   --  States in a sequence: 4 ** 6 sequences, and 2 ** 6 patterns of looks.

   subtype Index is Positive range 1 .. Length;

   type State_List is array (Index) of Controller_State;

   type Look_List is array (Index) of Boolean;

   function Sequence (Number : Natural) return State_List;
   --  The sequence with this number, from 0.

   function Looks (Number : Natural) return Look_List;
   --  The pattern of looks with this number, from 0; the last state has a look
   --  always.

   procedure Check_Single_Changes;
   --  A look after each state.

   procedure Check_Any_Looks;
   --  All patterns of looks.

   procedure Check_Counts;
   --  The counts of the log.

   procedure Check_Delay;
   --  Recovery is due after so many looks.

   --------------
   -- Sequence --
   --------------

   function Sequence (Number : Natural) return State_List is
      Left   : Natural := Number;
      Result : State_List;
   begin
      for I in Index loop
         Result (I) := Controller_State'Val (Left mod 4);
         Left       := Left / 4;
      end loop;
      return Result;
   end Sequence;

   -----------
   -- Looks --
   -----------

   function Looks (Number : Natural) return Look_List is
      Left   : Natural := Number;
      Result : Look_List;
   begin
      for I in Index loop
         Result (I) := Left mod 2 = 1;
         Left       := Left / 2;
      end loop;
      Result (Length) := True;
      return Result;
   end Looks;

   --------------------------
   -- Check_Single_Changes --
   --------------------------

   procedure Check_Single_Changes is
      Right : Boolean := True;
   begin
      for Number in 0 .. 4**Length - 1 loop
         declare
            States  : constant State_List := Sequence (Number);
            Log     : Fault_Log;
            Now     : Fault_Log;
            Found   : Notices;
            Faulty  : Boolean := False;
         begin
            for State of States loop
               Now   := Noted (Log, State);
               Found := Between (Log, Now);
               Right := Right
                 and then Found.Error_Passive =
                   (State = Error_Passive and then Log.State /= Error_Passive)
                 and then Found.Bus_Off =
                   (State = Bus_Off and then Log.State /= Bus_Off)
                 and then Found.Recovered =
                   (State = Error_Active and then Faulty);
               Faulty :=
                 (case State is
                    when Error_Passive | Bus_Off => True,
                    when Error_Active            => False,
                    when Stopped                 => Faulty);
               Log := Now;
            end loop;
         end;
      end loop;
      Facts.Check
        ("each change of state gives the notices of that change", Right);
   end Check_Single_Changes;

   ---------------------
   -- Check_Any_Looks --
   ---------------------

   procedure Check_Any_Looks is
      Missed  : Natural := 0;
      Made_Up : Natural := 0;
      Untrue  : Natural := 0;
   begin
      for Number in 0 .. 4**Length - 1 loop
         for Way in 0 .. 2**(Length - 1) - 1 loop
            declare
               States : constant State_List := Sequence (Number);
               Look   : constant Look_List := Looks (Way);
               Log    : Fault_Log;
               Seen   : Fault_Log;
               Found  : Notices;
               Owed   : Notices;
            begin
               for I in Index loop
                  Found := Between (Log, Noted (Log, States (I)));
                  Log   := Noted (Log, States (I));
                  Owed.Error_Passive :=
                    Owed.Error_Passive or else Found.Error_Passive;
                  Owed.Bus_Off := Owed.Bus_Off or else Found.Bus_Off;
                  if Look (I) then
                     Found := Between (Seen, Log);
                     if (Owed.Error_Passive and then not Found.Error_Passive)
                       or else (Owed.Bus_Off and then not Found.Bus_Off)
                     then
                        Missed := Missed + 1;
                     end if;
                     if (Found.Error_Passive and then not Owed.Error_Passive)
                       or else (Found.Bus_Off and then not Owed.Bus_Off)
                     then
                        Made_Up := Made_Up + 1;
                     end if;
                     if Found.Recovered and then Log.State /= Error_Active
                     then
                        Untrue := Untrue + 1;
                     end if;
                     if Log.State = Error_Active
                       and then Found.Recovered /=
                         (Seen.Disturbed
                          or else Found.Error_Passive
                          or else Found.Bus_Off)
                     then
                        Untrue := Untrue + 1;
                     end if;
                     Seen := Log;
                     Owed := (others => False);
                  end if;
               end loop;
            end;
         end loop;
      end loop;
      Facts.Check
        ("no fault between two looks is missed:" & Missed'Image, Missed = 0);
      Facts.Check ("and none is made up:" & Made_Up'Image, Made_Up = 0);
      Facts.Check
        ("who is notified of recovery finds the controller error-active:"
         & Untrue'Image, Untrue = 0);
   end Check_Any_Looks;

   ------------------
   -- Check_Counts --
   ------------------

   procedure Check_Counts is
      Log : Fault_Log;
   begin
      for Nth in 1 .. 3 loop
         Log := Noted (Log, Error_Active);
         Log := Noted (Log, Error_Passive);
         Log := Noted (Log, Error_Passive);
         Log := Noted (Log, Bus_Off);
      end loop;
      Log := Noted (Log, Stopped);
      Facts.Check
        ("entries and returns are counted, and a stop is neither",
         Log.Passive_Entries = 3
         and then Log.Off_Entries = 3
         and then Log.Returns = 2
         and then Log.Disturbed);
      Log := Noted (Log, Error_Active);
      Facts.Check
        ("behind a stop it is still a return",
         Log.Returns = 3 and then not Log.Disturbed);
   end Check_Counts;

   -----------------
   -- Check_Delay --
   -----------------

   procedure Check_Delay is
      First  : constant Notices := (Bus_Off => True, others => False);
      None   : constant Notices := (others => False);
      Left   : Look_Count := 5;
      Is_Due : Boolean;
      Right  : Boolean := True;
   begin
      for Round in 1 .. 3 loop
         Count_Off (Left, First, Bus_Off, 5, Is_Due);
         Right := Right and then not Is_Due;
         for Look in 1 .. 12 loop
            Count_Off (Left, None, Bus_Off, 5, Is_Due);
            Right := Right and then Is_Due = (Look mod 5 = 0);
         end loop;
      end loop;
      Facts.Check
        ("recovery is due 5 looks behind bus-off, and each 5 more", Right);
      Count_Off (Left, None, Error_Active, 5, Is_Due);
      Facts.Check
        ("it is not due when the controller is back",
         not Is_Due and then Left = 5);
      Count_Off (Left, First, Bus_Off, 1, Is_Due);
      Right := not Is_Due;
      Count_Off (Left, None, Bus_Off, 1, Is_Due);
      Facts.Check ("one look is a delay too", Right and then Is_Due);
   end Check_Delay;

begin
   Check_Single_Changes;
   Check_Any_Looks;
   Check_Counts;
   Check_Delay;
   Facts.Finish;
end Test_Fault_Notices;
