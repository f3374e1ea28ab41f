--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Task_Identification;
with Ada.Task_Termination;
with Ravenchart.Boards;
with System.Storage_Elements;

package body Ravenchart.Failures
  with SPARK_Mode => Off
--  ASM-014. The end of a task and of the program are reached through the
--  run-time library, the message of an exception by its address.
is
   use type Ada.Task_Identification.Task_Id;
   use type System.Address;
   use type System.Storage_Elements.Storage_Offset;

   procedure Make_All_Safe
   with Import, Convention => C, External_Name => "ravenchart_make_safe";
   pragma Weak_External (Make_All_Safe);
   --  Defined in a generated program with devices that can be made safe. In
   --  other programs its address is null.

   procedure Last_Chance (Message : System.Address; Line : Integer)
   with
     Export,
     Convention    => C,
     External_Name => "__gnat_last_chance_handler",
     No_Return;
   --  Handles an exception in any task: this run-time library propagates none.
   --  It makes the devices safe where they can be, then ends the controller.
   --  Message ends with a zero; Line is 0 where Message is not the name of a
   --  file.

   type Bounded_Name is record
      Length : Natural range 0 .. Longest_Name := 0;
      Text   : String (1 .. Longest_Name)      := (others => ' ');
   end record;

   type Known_Task is record
      Id   : Ada.Task_Identification.Task_Id :=
        Ada.Task_Identification.Null_Task_Id;
      Name : Bounded_Name;
   end record;

   subtype Task_Index is Positive range 1 .. 64;

   type Task_Table is array (Task_Index) of Known_Task;

   type Failure_Kind is (Is_Silent, Has_Ended);

   type Reason is record
      Kind : Failure_Kind := Is_Silent;
      Name : Bounded_Name;
   end record;

   subtype Reason_Index is Positive range 1 .. 32;

   type Reason_Table is array (Reason_Index) of Reason;

   function Bounded (Name : String) return Bounded_Name;

   protected Record_Of_All
     with Priority => System.Interrupt_Priority'First
   is
      procedure Add
        (Name : Bounded_Name; Id : Ada.Task_Identification.Task_Id);
      --  Note that there is a task with this name.

      procedure Find
        (Id : Ada.Task_Identification.Task_Id; Name : out Bounded_Name);
      --  The name of a task; empty where it has none.

      procedure Note_Silence (Name : Bounded_Name);
      --  Keep the reason.

      procedure On_End (T : Ada.Task_Identification.Task_Id);
      --  A task has ended. Called by the run-time library.

      function Any return Boolean;

      function Has_Tasks return Boolean;
      --  Has any task begun? All packages are then elaborated.

      procedure Take (Item : out Reason; Found : out Boolean);
      --  The oldest reason that was not taken.

   private
      Tasks   : Task_Table;
      Used    : Natural range 0 .. Task_Index'Last := 0;
      Reasons : Reason_Table;
      Kept    : Natural range 0 .. Reason_Index'Last := 0;
      Taken   : Natural range 0 .. Reason_Index'Last := 0;
      Failed  : Boolean := False;
   end Record_Of_All;

   Elaborated : Boolean := False;
   --  Is this body elaborated, so that there may be reasons?

   Ending : Boolean := False;
   --  Is this a second exception, raised while devices are made safe?

   -------------
   -- Bounded --
   -------------

   function Bounded (Name : String) return Bounded_Name is
      Length : constant Natural := Natural'Min (Name'Length, Longest_Name);
      Result : Bounded_Name;
   begin
      Result.Length := Length;
      Result.Text (1 .. Length) :=
        Name (Name'First .. Name'First + Length - 1);
      return Result;
   end Bounded;

   -------------------
   -- Record_Of_All --
   -------------------

   protected body Record_Of_All is

      procedure Keep (Kind : Failure_Kind; Name : Bounded_Name);

      procedure Keep (Kind : Failure_Kind; Name : Bounded_Name) is
      begin
         Failed := True;
         if Kept < Reason_Index'Last then
            Kept := Kept + 1;
            Reasons (Kept) := (Kind, Name);
         end if;
      end Keep;

      procedure Add
        (Name : Bounded_Name; Id : Ada.Task_Identification.Task_Id) is
      begin
         if Used < Task_Index'Last then
            Used := Used + 1;
            Tasks (Used) := (Id, Name);
         end if;
      end Add;

      procedure Find
        (Id : Ada.Task_Identification.Task_Id; Name : out Bounded_Name) is
      begin
         Name := (others => <>);
         for Item of Tasks (1 .. Used) loop
            if Item.Id = Id then
               Name := Item.Name;
            end if;
         end loop;
      end Find;

      procedure Note_Silence (Name : Bounded_Name) is
      begin
         Keep (Is_Silent, Name);
      end Note_Silence;

      procedure On_End (T : Ada.Task_Identification.Task_Id) is
         Name : Bounded_Name;
      begin
         Find (T, Name);
         Keep (Has_Ended, Name);
      end On_End;

      function Any return Boolean
      is (Failed);

      function Has_Tasks return Boolean
      is (Used > 0);

      procedure Take (Item : out Reason; Found : out Boolean) is
      begin
         Found := Taken < Kept;
         if Found then
            Taken := Taken + 1;
            Item  := Reasons (Taken);
         else
            Item := (others => <>);
         end if;
      end Take;

   end Record_Of_All;

   procedure Put_Name (Name : Bounded_Name);
   --  Begin a line about a task.

   --------------
   -- Put_Name --
   --------------

   procedure Put_Name (Name : Bounded_Name) is
   begin
      Boards.Put ("error: ");
      if Name.Length = 0 then
         Boards.Put ("a task without a name (a driver's or a user's)");
      else
         Boards.Put (Name.Text (1 .. Name.Length));
      end if;
   end Put_Name;

   --------------
   -- Register --
   --------------

   procedure Register (Name : String) is
   begin
      Record_Of_All.Add
        (Bounded (Name), Ada.Task_Identification.Current_Task);
   end Register;

   ------------------
   -- Note_Silence --
   ------------------

   procedure Note_Silence (Name : String) is
   begin
      Record_Of_All.Note_Silence (Bounded (Name));
   end Note_Silence;

   -----------------
   -- Stop_Needed --
   -----------------

   function Stop_Needed return Boolean
   is (Record_Of_All.Any);

   ---------------
   -- Put_Error --
   ---------------

   procedure Put_Error (Text : String) is
   begin
      Boards.Put (Text);
      Boards.Put ((1 => ASCII.LF));
   end Put_Error;

   -----------------
   -- Put_Reasons --
   -----------------

   procedure Put_Reasons is
      Item  : Reason;
      Found : Boolean;
   begin
      loop
         Record_Of_All.Take (Item, Found);
         exit when not Found;
         Put_Name (Item.Name);
         Boards.Put
           (case Item.Kind is
               when Is_Silent =>
                  " is silent: a release has not completed by its deadline"
                  & " and the margin of its supervision",
               when Has_Ended =>
                  " has ended: it came to the end of its body");
         Boards.Put ((1 => ASCII.LF));
      end loop;
   end Put_Reasons;

   -------------------
   -- Feed_Watchdog --
   -------------------

   procedure Feed_Watchdog is
   begin
      Boards.Feed_Watchdog;
   end Feed_Watchdog;

   -----------------
   -- Last_Chance --
   -----------------

   procedure Last_Chance (Message : System.Address; Line : Integer) is
      Number : constant String := Line'Image;
      Here   : System.Address := Message;
      Name   : Bounded_Name;
   begin
      --  End the line that this one interrupts.
      Boards.Put ((1 => ASCII.LF));
      if Elaborated then
         Put_Reasons;
         Record_Of_All.Find (Ada.Task_Identification.Current_Task, Name);
      end if;
      if Name.Length > 0 then
         Put_Name (Name);
      else
         Boards.Put ("error: the main program");
      end if;
      Boards.Put (" has ended by an exception: ");
      loop
         declare
            Letter : Character
            with Import, Address => Here;
         begin
            exit when Letter = ASCII.NUL;
            Boards.Put ((1 => Letter));
         end;
         Here := Here + 1;
      end loop;
      if Line > 0 then
         Boards.Put (":");
         Boards.Put (Number (Number'First + 1 .. Number'Last));
      end if;
      Boards.Put ((1 => ASCII.LF));
      if Elaborated and then Record_Of_All.Has_Tasks
        and then Make_All_Safe'Address /= System.Null_Address
        and then not Ending
      then
         Ending := True;
         Make_All_Safe;
      end if;
      Boards.Finish (Success => False);
   end Last_Chance;

   -------------
   -- Give_Up --
   -------------

   procedure Give_Up is
   begin
      Boards.Put ((1 => ASCII.LF));
      Put_Reasons;
      Boards.Put
        ("error: the main program did not end the controller in time: its"
         & " report is missing" & ASCII.LF);
      Boards.Finish (Success => False);
   end Give_Up;

begin
   Ada.Task_Termination.Set_Dependents_Fallback_Handler
     (Record_Of_All.On_End'Access);
   Elaborated := True;
end Ravenchart.Failures;
