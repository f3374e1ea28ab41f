--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

package body Ravenchart.Firing_Lists
  with SPARK_Mode
is
   ---------
   -- Add --
   ---------

   procedure Add (Fired : in out List; T : Selection) is
   begin
      Fired.Count               := Fired.Count + 1;
      Fired.Items (Fired.Count) := T;
   end Add;

end Ravenchart.Firing_Lists;
