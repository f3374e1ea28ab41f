--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The execution of a simulated program, step by step, on standard output.
--
--  Guarantees   one line for each step that executed a behaviour:
--               "0.020 motor.Motion: Idle.exit, T3.effect, Moving.entry"
--  Tasking      one task
--  Timing       none: not for a controller

package Ravenchart.Steps is

   procedure Set_Time (Now : Long_Long_Integer);
   --  Set the instant of the next lines, in ns since the epoch.

   function Now return Long_Long_Integer;
   --  The instant that was set.

   procedure Note (Behaviour : String);
   --  Note that the step under way executes this behaviour.

   procedure Finish (Region : String);
   --  End the step of Region: write its line, if it has one.

   procedure Put_Value (Element : String; Value : Number);
   --  Write the line of a recorded value: "0.020 motor.speed = 12".

   procedure Get (Value : out Long_Long_Integer);
   --  Read the next number from standard input.

end Ravenchart.Steps;
