--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Snapshots of a running controller for `ravenchart monitor`: the report up
--  to now, written ten times a second into the same file.
--
--  Guarantees   no reader can disturb or delay the controller; a reader can
--               distinguish a complete snapshot from one that is being
--               written. A snapshot counts the lines and records that it does
--               not hold
--  Tasking      the environment task only, at the lowest priority
--  Timing       not bounded: it may wait for a disk
--  Assumptions  ASM-002
--
--  The environment variable RAVENCHART_MONITOR names the file; without it
--  there are no snapshots. The process holds a lock on the file (lockf) for as
--  long as it lives. First line: S sequence length, 22 bytes with its LF;
--  length counts the bytes of all lines. Last line: S sequence. Between them
--  are lines of the report (Ravenchart.Hosts). T lines are the last
--  transitions and faults. A line "C kind element count time value" gives the
--  number of records of a kind of an element, and the last of them; the kind
--  of recorded values is VALUE. "L snapshot" counts the lines and records that
--  did not fit.

private package Ravenchart.Hosts.Snapshots
  with SPARK_Mode => Off
--  ASM-002. Files and locks are reached through the C library.
is
   procedure Open;
   --  Open and lock the file, if one is named.

   procedure Note (Text : String);
   --  Text is a line of the report, with its LF.

   procedure Refresh;
   --  Write a snapshot, if the last one is at least a tenth of a second old.
   --  Its counts are in the report as well, so that a replay shows them at
   --  their time.

   procedure Close;
   --  Write the last snapshot, with the counts at the end of the report.

end Ravenchart.Hosts.Snapshots;
