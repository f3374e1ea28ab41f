--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The chart of model.yaml as written by hand: nested case statements, one
--  procedure for each composite that handles the events that its substates do
--  not handle.

with Chart_Bench;

package Hand_Written is

   type Leaf is (One_Leaf, One_Other, Two_Leaf, Two_Other);

   type Event is (Go, Back, Tick, Unknown, Reset);

   type Machine is record
      Where   : Leaf := One_Leaf;
      Exits   : Chart_Bench.Count := 0;
      Entries : Chart_Bench.Count := 0;
      Ticks   : Chart_Bench.Count := 0;
   end record;

   procedure Start (Self : in out Machine);

   procedure Dispatch
     (Self  : in out Machine;
      Item  : Event;
      Taken : out Boolean);

end Hand_Written;
