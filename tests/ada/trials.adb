--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

with Ada.Command_Line;

package body Trials is

   use Ada.Command_Line;

   -----------
   -- Times --
   -----------

   function Times return Positive
   is (if Argument_Count = 0 then 10 else Positive'Value (Argument (1)));

   ------------
   -- Prints --
   ------------

   function Prints return Boolean
   is (Argument_Count > 0 and then Argument (1) = "print");

end Trials;
