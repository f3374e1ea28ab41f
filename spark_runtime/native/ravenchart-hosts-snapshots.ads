--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Snapshots of a running controller for `ravenchart monitor`: what its report
--  would say now, written ten times a second into one file, over and over.
--
--  Guarantees   no reader can disturb or delay the controller; a reader can
--               tell a whole snapshot from one that is being written; what a
--               snapshot does not hold is counted in it
--  Tasking      the environment task only, at the lowest priority
--  Timing       not bounded: it may wait for a disk
--  Assumptions  ASM-002
--
--  The file is the one that the environment variable RAVENCHART_MONITOR names;
--  without it nothing is done. The process holds a lock on it (lockf) for as
--  long as it lives. First line: S sequence length, 22 bytes with its LF;
--  length counts the bytes of all lines. Last line: S sequence. Between them,
--  lines of the report (Ravenchart.Hosts): T lines are the last transitions
--  and faults. A line "C kind element count time value" says how many records
--  of a kind there were of an element, and what the last one was; those of
--  recorded values are of the kind VALUE. "L snapshot" counts the lines and
--  records that found no room.

private package Ravenchart.Hosts.Snapshots
  with SPARK_Mode => Off
--  ASM-002. Files and locks are reached through the C library.
is
   procedure Open;
   --  Open and lock the file, if one is named.

   procedure Note (Text : String);
   --  Text is a line of the report, with its LF.

   procedure Refresh;
   --  Write a snapshot, if the last one is a tenth of a second old. Its counts
   --  are in the report as well: a replay shows them at their time.

   procedure Close;
   --  Write the last snapshot: with the counts of the end of the report.

end Ravenchart.Hosts.Snapshots;
