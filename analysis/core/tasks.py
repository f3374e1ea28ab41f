# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Tasks of fixed priority on one core each, and the tables that they execute."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction

from .checks import at_most, distinct, natural, positive

FRAME_LIMIT = 1024
"""Releases after which a table must repeat; with more, every row counts in every job."""


@dataclass(frozen=True, slots=True)
class TableRow:
    """One row of a task's table: executed in release k when k mod ``every`` is ``phase``.

    ``wcet`` is its worst-case execution time in ticks, above 0.
    """

    name: str
    wcet: int
    every: int = 1
    phase: int = 0

    def __post_init__(self) -> None:
        """Refuse values out of range, with a ValueError that names the row."""
        owner = f"row {self.name}"
        positive(owner, wcet=self.wcet, every=self.every)
        natural(owner, phase=self.phase)
        if self.phase >= self.every:
            raise ValueError(f"phase of {owner} must be below {self.every}, not {self.phase}")


@dataclass(frozen=True, slots=True)
class Task:
    """A periodic or sporadic task.

    All times are in ticks.

        ``period``     T: distance of its arrivals (least when ``sporadic``), above 0
        ``deadline``   D: from the arrival, above 0; it may exceed the period
        ``wcet``       C: worst-case execution time of every job, apart from the rows
        ``priority``   a larger number is more urgent
        ``jitter``     J: longest time from the arrival to the release, any size
        ``rows``       the rows that a job executes in addition, in this order
        ``timed``      released by the tick of its core: late by up to one tick period
        ``sporadic``   no job is certain to arrive; the analysis of responses is the same
        ``best``       least execution time of a job, for the jitter of the released items
        ``held``       longest blocking of all its jobs between two idle instants, apart from
                       the sections: by work outside the system's tasks, or by another
                       locking protocol (the blocking term B of Audsley et al. 1993)
        ``suspensions``  times that a job waits: each needs two context switches and
                         the work of making it ready
        ``offset``     arrival of job 0 of the cycle, after an epoch; None where unknown
        ``epoch``      the epoch of the offset; the distance of two epochs of a core is unknown
        ``summed``     others count each row by itself, as if phases kept no two rows apart
    """

    name: str
    priority: int
    period: int
    deadline: int
    wcet: int = 0
    jitter: int = 0
    core: str = ""
    rows: tuple[TableRow, ...] = ()
    timed: bool = False
    sporadic: bool = False
    best: int = 0
    held: int = 0
    suspensions: int = 1
    offset: int | None = None
    epoch: str = ""
    summed: bool = False

    def __post_init__(self) -> None:
        """Refuse values out of range, with a ValueError that names field and task."""
        owner = f"task {self.name}"
        positive(owner, period=self.period, deadline=self.deadline, suspensions=self.suspensions)
        natural(owner, jitter=self.jitter, best=self.best, held=self.held, offset=self.offset or 0)
        if self.sporadic and self.offset is not None:
            raise ValueError(f"offset of {owner} has no meaning: it is sporadic")
        if self.epoch and self.offset is None:
            raise ValueError(f"epoch of {owner} has no meaning: it has no offset")
        if self.rows:
            natural(owner, wcet=self.wcet)
            distinct(f"rows of {owner}", [row.name for row in self.rows])
        else:
            positive(owner, wcet=self.wcet)
        at_most(owner, "best", self.best, self.plain_wcet)

    @property
    def plain_wcet(self) -> int:
        """The longest job if every row were executed in it."""
        return self.wcet + sum(row.wcet for row in self.rows)

    @property
    def longest_wcet(self) -> int:
        """The longest job, of the rows that its release executes."""
        return self.wcet + max((sum(row.wcet for row in rows) for rows in self.frames), default=0)

    @property
    def frame_count(self) -> int:
        """Releases after which the table repeats; 1 where that is above `FRAME_LIMIT`."""
        count = math.lcm(*(row.every for row in self.rows))
        return count if count <= FRAME_LIMIT else 1

    @property
    def frames(self) -> tuple[tuple[TableRow, ...], ...]:
        """The rows of each release until the table repeats; all in one past the limit."""
        count = self.frame_count
        if count == 1:
            return (self.rows,)
        return tuple(
            tuple(row for row in self.rows if k % row.every == row.phase) for k in range(count)
        )

    def at_any_time(self) -> Task:
        """The same task with an unknown offset."""
        return replace(self, offset=None, epoch="")

    @property
    def utilisation(self) -> Fraction:
        """Share of its core that the task needs in the long run, overheads apart."""
        if not self.rows:
            return Fraction(self.wcet, self.period)
        total = sum(self.wcet + sum(row.wcet for row in rows) for rows in self.frames)
        return Fraction(total, self.period * self.frame_count)


def is_phased(task: Task) -> bool:
    """Whether phases keep rows of the task apart."""
    return any(row.phase for row in task.rows)


def without_phases(task: Task) -> Task:
    """The same task with a job that executes all rows: no phases demand more."""
    rows = tuple(replace(row, phase=0) for row in task.rows)
    return replace(task, rows=rows, summed=False)


def with_full_jobs(task: Task) -> Task:
    """The same task with every row in every job, at any time, as in a calculation by hand."""
    return replace(task.at_any_time(), wcet=task.plain_wcet, rows=())
