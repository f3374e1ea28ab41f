--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  The objects between a main program on core 1 and a task on core 2, and what
--  the task has found. The values are large, so that to copy one takes longer
--  than an access of the other core.

with Ravenchart.Crossing_Boards;
with Ravenchart.Crossing_Queues;
with Ravenchart.Crossing_Samples;

package Crossed
  with Elaborate_Body
is

   type Block is array (1 .. 64) of Natural;
   --  A value: the same number everywhere, counted from 1.

   Empty : constant Block := (others => 0);

   package Board is new Ravenchart.Crossing_Boards
     (Element_Type => Block,
      Initial      => Empty);

   package Sample is new Ravenchart.Crossing_Samples
     (Element_Type => Block,
      Null_Element => Empty);

   package Queue is new Ravenchart.Crossing_Queues
     (Element_Type => Block,
      Null_Element => Empty,
      Capacity     => 8);

   type Findings is record
      Different : Natural := 0;  --  values, one after the other
      Torn      : Natural := 0;  --  not the same number everywhere
      Backwards : Natural := 0;  --  older than the one before
      Left_Out  : Natural := 0;  --  not the one after the one before
   end record;

   type Stage is (Of_Board, Of_Sample, Of_Queue);

   Found : array (Stage) of Findings;
   --  Complete when the stage is done.

   Last : Natural := 0
   with Atomic;
   --  The number of the last value of each stage, once it is known.

   Done : Natural := 0
   with Atomic;
   --  How many stages the reader has done.

end Crossed;
