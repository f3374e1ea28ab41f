--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A device that fails its start keeps the controller from starting. Programs
--  whose devices have start operations have this unit.
--
--  Guarantees   the reason reaches the host; the caller ends the program
--  Tasking      the main program alone
--  Timing       may wait for the host
--  Assumptions  ASM-019, the body does what this specification states

package Ravenchart.Device_Failures
  with
    SPARK_Mode,
    Elaborate_Body,
    Abstract_State => (Reasons with External => (Async_Readers,
                                                 Effective_Writes)),
    Initializes    => Reasons
is
   Longest_Name : constant := 128;

   procedure Note (Device : String)
   with
     Global => (In_Out => Reasons),
     Pre    => Device'Length in 1 .. Longest_Name;
   --  The device with this name has failed its initialisation or self-test.

   procedure Note_Late
   with Global => (In_Out => Reasons);
   --  The devices were not ready by the first release.

end Ravenchart.Device_Failures;
