--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  What a simulated program has executed, step by step, on standard output.
--
--  Guarantees   one line for each step that executed a behaviour:
--               "0.020 motor.Motion: Idle.exit, T3.effect, Moving.entry"
--  Tasking      one task
--  Timing       none: this is not for a controller

package Ravenchart.Steps is

   procedure Set_Time (Now : Long_Long_Integer);
   --  The instant of what follows, in ns since the epoch.

   function Now return Long_Long_Integer;
   --  That instant.

   procedure Note (Behaviour : String);
   --  A behaviour of the step under way is executed.

   procedure Finish (Region : String);
   --  The step of Region is over: put its line, if it has one.

   procedure Put_Value (Element : String; Value : Number);
   --  A value is recorded: put its line, "0.020 motor.speed = 12".

   procedure Get (Value : out Long_Long_Integer);
   --  The next number on standard input.

end Ravenchart.Steps;
