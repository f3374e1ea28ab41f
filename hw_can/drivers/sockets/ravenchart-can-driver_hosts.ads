--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Services of the host for the drivers by sockets and serial lines: settings
--  from the environment, and messages to the user.
--
--  Guarantees   no exception is raised
--  Tasking      the two tasks of a driver; each call is independent
--  Timing       that of the system

package Ravenchart.Can.Driver_Hosts
  with
    SPARK_Mode,
    Abstract_State =>
      (Console with Synchronous,
                    External => (Async_Readers, Async_Writers,
                                 Effective_Reads, Effective_Writes)),
    Initializes    => Console
is
   Text_Limit : constant := 1_024;
   --  The most characters of a setting.

   procedure Read_Setting
     (Name, Bus_Name : String; Text : out String; Last : out Natural)
   with
     Global => null,
     Pre    => Text'First = 1 and then Text'Last in 1 .. Text_Limit,
     Post   => Last <= Text'Last;
   --  The value of an environment variable, cut off where Text ends. Name, "_"
   --  and Bus_Name is its name, or Name where that is not set; Text is empty
   --  when neither is.

   procedure Announce (Text : String; About : String)
   with
     Global => (In_Out => Console),
     Pre    =>
       Text'Length <= Text_Limit and then About'Length <= Text_Limit;
   --  Print both to standard output.

   procedure Announce (Text : String; Number : Natural)
   with Global => (In_Out => Console), Pre => Text'Length <= Text_Limit;
   --  The same with a number.

   procedure Complain
     (Bus    : Bus_Place;
      Reason : String;
      About  : String := "";
      Rest   : String := "")
   with
     Global => (In_Out => Console),
     Pre    =>
       Reason'Length <= Text_Limit
       and then About'Length <= Text_Limit
       and then Rest'Length <= Text_Limit;
   --  Print an error message of three parts to standard error: the first one
   --  of each bus only, as most operations are retried.

   procedure Complain
     (Bus : Bus_Place; Reason : String; Number : Natural; Rest : String)
   with
     Global => (In_Out => Console),
     Pre    =>
       Reason'Length <= Text_Limit and then Rest'Length <= Text_Limit;
   --  The same with a number.

end Ravenchart.Can.Driver_Hosts;
