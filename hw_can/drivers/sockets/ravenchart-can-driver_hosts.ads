--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What the drivers by sockets and serial lines ask of the host beside these:
--  settings from the environment, and messages to whoever started the
--  program.
--
--  Guarantees   nothing is raised
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
   Text_Limit : constant := 4_000;
   --  The most characters of a setting; others are cut off.

   function Setting (Name : String) return String
   with
     Global => null,
     Post   =>
       Setting'Result'First = 1
       and then Setting'Result'Length <= Text_Limit;
   --  What the environment says; nothing when it is not set.

   procedure Announce (Text : String; About : String)
   with Global => (In_Out => Console);
   --  Print Text and About to standard output.

   procedure Complain
     (Reason : String; About : String := ""; Rest : String := "")
   with Global => (In_Out => Console);
   --  Say on standard error what is wrong, the three parts in a row: the
   --  first time only, as most is tried again.

end Ravenchart.Can.Driver_Hosts;
