--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  A program in virtual time, without tasks. It executes each release of each
--  processor in order of time and, at one instant, of the array; the stimuli
--  of an instant come before its releases. Standard input holds the last
--  instant, then for each stimulus its instant, its number and its values, all
--  as integers.

generic
   type Processor is range <>;
   --  The processors by priority, the most urgent first.
   type Instants is array (Processor) of Long_Long_Integer;
   Offsets : Instants;
   Periods : Instants;
   --  The period of each processor in ns.
   with procedure Release (P : Processor; Count : Natural);
   --  Run the rows of release number Count.
   with procedure Take (Number : Positive);
   --  Apply a stimulus; its values are read by Ravenchart.Steps.Get.
   with procedure End_Instant is null;
   --  Called when all releases of an instant have been executed.
procedure Ravenchart.Simulated_Runs;
