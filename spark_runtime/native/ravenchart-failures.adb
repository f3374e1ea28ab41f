--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Exceptions;
with Ada.Task_Identification;
with Ada.Task_Termination;
with Interfaces.C.Strings;
with System;
with System.Storage_Elements;

package body Ravenchart.Failures
  with SPARK_Mode => Off
--  ASM-014. Handlers of task termination, the scheduling policy of a thread,
--  its stack for signals and files are reached through the run-time library
--  and the C library.
is
   use type Ada.Task_Identification.Task_Id;
   use type Interfaces.C.int;
   use type Interfaces.C.Strings.chars_ptr;
   use type System.Address;

   subtype C_Int is Interfaces.C.int;

   subtype Thread_Id is Interfaces.C.unsigned_long;
   --  pthread_t of Linux.

   --  The C library

   function C_Thread_Self return Thread_Id
   with Import, Convention => C, External_Name => "pthread_self";

   type Scheduling_Parameter is record
      Priority : C_Int := 0;
   end record
   with Convention => C;

   function C_Set_Scheduling
     (Thread    : Thread_Id;
      Policy    : C_Int;
      Parameter : access Scheduling_Parameter) return C_Int
   with Import, Convention => C, External_Name => "pthread_setschedparam";

   type Signal_Stack is record
      Base  : System.Address          := System.Null_Address;
      Flags : C_Int                   := 0;
      Size  : Interfaces.C.size_t     := 0;
   end record
   with Convention => C;
   --  stack_t of Linux.

   function C_Signal_Stack
     (Item : access Signal_Stack; Old : System.Address) return C_Int
   with Import, Convention => C, External_Name => "sigaltstack";

   function C_Get_Environment
     (Name : Interfaces.C.char_array) return Interfaces.C.Strings.chars_ptr
   with Import, Convention => C, External_Name => "getenv";

   function C_Open
     (Path : Interfaces.C.Strings.chars_ptr; Flags : C_Int) return C_Int
   with Import, Convention => C_Variadic_2, External_Name => "open";

   function C_Write
     (File : C_Int; Data : System.Address; Length : Interfaces.C.size_t)
      return Interfaces.C.long
   with Import, Convention => C, External_Name => "write";

   procedure Make_All_Safe
   with Import, Convention => C, External_Name => "ravenchart_make_safe";
   pragma Weak_External (Make_All_Safe);
   --  Defined in a generated program with devices that can be made safe. In
   --  other programs its address is null.

   procedure C_Exit (Status : C_Int)
   with Import, Convention => C, External_Name => "_exit", No_Return;

   --  The numbers of Linux

   Standard_Error : constant C_Int := 2;
   Round_Robin    : constant C_Int := 2;
   --  SCHED_RR. It must be a real-time policy: under SCHED_OTHER the kernel
   --  refuses the ceiling of every protected object, and each call of one
   --  would raise Program_Error.
   Least_Urgent   : constant Scheduling_Parameter := (Priority => 1);
   --  The priority of the environment task, which still runs under this
   --  policy.
   Write_Only     : constant C_Int := 8#1#;
   Nonblocking    : constant C_Int := 8#4000#;
   No_File        : constant C_Int := -1;

   --  Texts

   Longest_Text : constant := 320;

   type Bounded_Text is record
      Length : Natural range 0 .. Longest_Text := 0;
      Text   : String (1 .. Longest_Text)      := (others => ' ');
   end record;

   function Bounded (Text : String) return Bounded_Text;
   --  Text, cut off where it does not fit.

   Of_Memory : constant String :=
     "a stack overflow, or an access to memory that the task does not have";

   function Is_Of_Memory
     (X : Ada.Exceptions.Exception_Occurrence) return Boolean
   is (Ada.Exceptions."="
         (Ada.Exceptions.Exception_Identity (X), Storage_Error'Identity));
   --  Is X such a failure? Its message is then only a line of the run-time
   --  library.

   type Known_Task is record
      Id     : Ada.Task_Identification.Task_Id :=
        Ada.Task_Identification.Null_Task_Id;
      Thread : Thread_Id := 0;
      Name   : Bounded_Text;
      Ended  : Boolean := False;
   end record;

   subtype Task_Index is Positive range 1 .. 256;

   type Task_Table is array (Task_Index) of Known_Task;

   subtype Stack_Place is
     System.Storage_Elements.Storage_Array (1 .. 32_768);
   --  The same size as the run-time library gives the environment task.

   type Stack_Table is array (Task_Index) of aliased Stack_Place;

   Signal_Stacks : Stack_Table;
   --  The stack on which a task handles the signal of a stack overflow. Tasks
   --  of the restricted run-time library have none of their own, and without
   --  one the kernel ends the process. A page that is never used takes no
   --  memory.

   subtype Reason_Index is Positive range 1 .. 32;

   type Reason_Table is array (Reason_Index) of Bounded_Text;

   type Thread_Search is record
      Found  : Boolean   := False;
      Thread : Thread_Id := 0;
   end record;

   protected Record_Of_All
     with Priority => System.Priority'Last
   is
      procedure Add
        (Name : String; Thread : Thread_Id; Number : out Natural);
      --  Note that the caller is a task with this name and thread. Its number
      --  is 0 where the table is full.

      procedure Note_Silence (Name : String; Culprit : out Thread_Search);
      --  Keep the reason; of the first silence, also the thread that may delay
      --  the others.

      procedure On_End
        (Cause : Ada.Task_Termination.Cause_Of_Termination;
         T     : Ada.Task_Identification.Task_Id;
         X     : Ada.Exceptions.Exception_Occurrence);
      --  A task has ended. Called by the run-time library.

      function Any return Boolean;

      function Has_Tasks return Boolean;
      --  Has any task begun? All packages are then elaborated.

      procedure Take (Reason : out Bounded_Text);
      --  The oldest reason that was not taken; empty when there is none.

   private
      Tasks   : Task_Table;
      Used    : Natural range 0 .. Task_Index'Last := 0;
      Reasons : Reason_Table;
      Kept    : Natural range 0 .. Reason_Index'Last := 0;
      Taken   : Natural range 0 .. Reason_Index'Last := 0;
      Failed  : Boolean := False;
      Demoted : Boolean := False;
   end Record_Of_All;

   procedure Last_Chance (X : Ada.Exceptions.Exception_Occurrence)
   with
     Export,
     Convention    => C,
     External_Name => "__gnat_last_chance_handler",
     No_Return;
   --  Handles an exception in the environment task, from the elaboration of a
   --  package or from the main program, that nothing else handles. It makes
   --  the devices safe where they can be, then ends the process. It replaces
   --  the handler of the run-time library, which waits for the other tasks,
   --  and these never end.

   Ending : Boolean := False;
   --  Is this a second exception, raised while devices are made safe?

   Elaborated : Boolean := False;
   --  Is this body elaborated, so that there may be reasons?

   Watchdog : C_Int := No_File;
   --  The file that the environment variable RAVENCHART_WATCHDOG names, if it
   --  can be written: a watchdog of Linux, which each byte feeds.

   -------------
   -- Bounded --
   -------------

   function Bounded (Text : String) return Bounded_Text is
      Length : constant Natural := Natural'Min (Text'Length, Longest_Text);
      Result : Bounded_Text;
   begin
      Result.Length := Length;
      Result.Text (1 .. Length) :=
        Text (Text'First .. Text'First + Length - 1);
      return Result;
   end Bounded;

   ---------------
   -- Put_Error --
   ---------------

   procedure Put_Error (Text : String) is
      Line    : constant String := Text & ASCII.LF;
      Ignored : Interfaces.C.long;
   begin
      Ignored := C_Write
        (Standard_Error, Line'Address, Interfaces.C.size_t (Line'Length));
   end Put_Error;

   -------------------
   -- Record_Of_All --
   -------------------

   protected body Record_Of_All is

      procedure Keep (Text : String);

      procedure Keep (Text : String) is
      begin
         Failed := True;
         if Kept < Reason_Index'Last then
            Kept := Kept + 1;
            Reasons (Kept) := Bounded (Text);
         end if;
      end Keep;

      procedure Add
        (Name : String; Thread : Thread_Id; Number : out Natural) is
      begin
         Number := 0;
         if Used < Task_Index'Last then
            Used   := Used + 1;
            Number := Used;
            Tasks (Used) :=
              (Id     => Ada.Task_Identification.Current_Task,
               Thread => Thread,
               Name   => Bounded (Name),
               Ended  => False);
         end if;
      end Add;

      procedure Note_Silence (Name : String; Culprit : out Thread_Search) is
         Wanted : constant Bounded_Text := Bounded (Name);
      begin
         Culprit := (others => <>);
         Keep
           (Name & " is silent: a release has not completed by its deadline"
            & " and the margin of its supervision");
         if not Demoted then
            for Item of Tasks (1 .. Used) loop
               if Item.Name = Wanted and then not Item.Ended then
                  Culprit := (Found => True, Thread => Item.Thread);
                  Demoted := True;
               end if;
            end loop;
         end if;
      end Note_Silence;

      procedure On_End
        (Cause : Ada.Task_Termination.Cause_Of_Termination;
         T     : Ada.Task_Identification.Task_Id;
         X     : Ada.Exceptions.Exception_Occurrence)
      is
         Name : Bounded_Text :=
           Bounded ("a task without a name (a driver's or a user's)");
      begin
         for Item of Tasks (1 .. Used) loop
            if Item.Id = T then
               Item.Ended := True;
               Name := Item.Name;
            end if;
         end loop;
         case Cause is
            when Ada.Task_Termination.Normal =>
               Keep (Name.Text (1 .. Name.Length)
                     & " has ended: it came to the end of its body");
            when Ada.Task_Termination.Abnormal =>
               Keep (Name.Text (1 .. Name.Length)
                     & " has ended: it was aborted");
            when Ada.Task_Termination.Unhandled_Exception =>
               Keep (Name.Text (1 .. Name.Length) & " has ended by "
                     & Ada.Exceptions.Exception_Name (X) & ": "
                     & (if Is_Of_Memory (X) then Of_Memory
                        else Ada.Exceptions.Exception_Message (X)));
         end case;
      end On_End;

      function Any return Boolean
      is (Failed);

      function Has_Tasks return Boolean
      is (Used > 0);

      procedure Take (Reason : out Bounded_Text) is
      begin
         if Taken < Kept then
            Taken  := Taken + 1;
            Reason := Reasons (Taken);
         else
            Reason := (others => <>);
         end if;
      end Take;

   end Record_Of_All;

   --------------
   -- Register --
   --------------

   procedure Register (Name : String) is
      Number  : Natural;
      Stack   : aliased Signal_Stack;
      Ignored : C_Int;
   begin
      Record_Of_All.Add (Name, C_Thread_Self, Number);
      if Number > 0 then
         Stack.Base := Signal_Stacks (Number)'Address;
         Stack.Size := Stack_Place'Length;
         Ignored := C_Signal_Stack (Stack'Access, System.Null_Address);
      end if;
   end Register;

   ------------------
   -- Note_Silence --
   ------------------

   procedure Note_Silence (Name : String) is
      Culprit : Thread_Search;
      Lowest  : aliased Scheduling_Parameter := Least_Urgent;
      Ignored : C_Int;
   begin
      Record_Of_All.Note_Silence (Name, Culprit);
      if Culprit.Found then
         Ignored :=
           C_Set_Scheduling (Culprit.Thread, Round_Robin, Lowest'Access);
      end if;
   end Note_Silence;

   -----------------
   -- Stop_Needed --
   -----------------

   function Stop_Needed return Boolean
   is (Record_Of_All.Any);

   -----------------
   -- Put_Reasons --
   -----------------

   procedure Put_Reasons is
      Reason : Bounded_Text;
   begin
      loop
         Record_Of_All.Take (Reason);
         exit when Reason.Length = 0;
         Put_Error ("error: " & Reason.Text (1 .. Reason.Length));
      end loop;
   end Put_Reasons;

   -------------------
   -- Feed_Watchdog --
   -------------------

   procedure Feed_Watchdog is
      Byte    : constant String := "F";
      Ignored : Interfaces.C.long;
   begin
      if Watchdog /= No_File then
         Ignored := C_Write (Watchdog, Byte'Address, 1);
      end if;
   end Feed_Watchdog;

   -----------------
   -- Last_Chance --
   -----------------

   procedure Last_Chance (X : Ada.Exceptions.Exception_Occurrence) is
   begin
      if Elaborated then
         Put_Reasons;
      end if;
      Put_Error
        ("error: the main program has ended by "
         & Ada.Exceptions.Exception_Name (X) & ": "
         & (if Is_Of_Memory (X) then Of_Memory
            else Ada.Exceptions.Exception_Message (X)));
      if Elaborated and then Record_Of_All.Has_Tasks
        and then Make_All_Safe'Address /= System.Null_Address
        and then not Ending
      then
         Ending := True;
         Make_All_Safe;
      end if;
      C_Exit (1);
   end Last_Chance;

   -------------
   -- Give_Up --
   -------------

   procedure Give_Up is
   begin
      Put_Reasons;
      Put_Error
        ("error: the main program did not end the controller in time: its"
         & " report is missing");
      C_Exit (1);
   end Give_Up;

   Path : constant Interfaces.C.Strings.chars_ptr :=
     C_Get_Environment (Interfaces.C.To_C ("RAVENCHART_WATCHDOG"));

begin
   Ada.Task_Termination.Set_Dependents_Fallback_Handler
     (Record_Of_All.On_End'Access);
   Elaborated := True;
   if Path /= Interfaces.C.Strings.Null_Ptr then
      Watchdog := C_Open (Path, Write_Only + Nonblocking);
      if Watchdog < 0 then
         Watchdog := No_File;
         Put_Error
           ("warning: the watchdog named by RAVENCHART_WATCHDOG cannot be"
            & " opened: nothing feeds it");
      end if;
   end if;
end Ravenchart.Failures;
