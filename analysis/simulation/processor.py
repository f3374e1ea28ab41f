# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One core: preemptive fixed priorities, first-in first-out among equals, immediate ceilings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from ravenchart.analysis.core.tasks import Task

from .phases import InsideSection


@dataclass(slots=True)
class JobStretch:
    """A stretch of a job: ticks left, priority inside, and the row that ends with it."""

    left: int
    level: int
    row: str = ""
    begun: bool = False


@dataclass(slots=True)
class Job:
    """A released job of ``task``; ``event`` began its chain, ``arrival`` and ``order`` itself."""

    task: Task
    number: int
    event: int
    arrival: int
    order: int
    segments: list[JobStretch] = field(default_factory=list)

    def urgency(self) -> tuple[int, bool, int]:
        """Its priority now, whether it is inside an object, and its order of arrival."""
        segment = self.segments[0]
        if segment.begun:
            return segment.level, segment.level > self.task.priority, -self.order
        return self.task.priority, False, -self.order


def segments_of(
    task: Task, frame: int, inside: tuple[InsideSection, ...], ceilings: Mapping[str, int]
) -> list[JobStretch]:
    """The stretches of job ``frame`` of the table's cycle: cut where a row or a section ends."""
    rows = list(_rows(task, frame))
    cuts = {end for end, _ in rows}
    for one in inside:
        cuts |= {one.start, one.start + one.section.length}
    names = dict(rows)
    found = []
    before = 0
    for cut in sorted(cuts - {0}):
        level = max(
            (
                ceilings[one.section.resource]
                for one in inside
                if one.start <= before < one.start + one.section.length
            ),
            default=task.priority,
        )
        found.append(JobStretch(cut - before, max(level, task.priority), names.get(cut, "")))
        before = cut
    return found


def _rows(task: Task, frame: int) -> Iterator[tuple[int, str]]:
    """The end of each row within the job; the task's own work comes before all rows."""
    at = task.wcet
    yield at, ""
    for row in task.frames[frame]:
        at += row.wcet
        yield at, row.name


@dataclass(slots=True)
class SimulatedProcessor:
    """The state of one core at the time ``now``."""

    now: int = 0
    ready: list[Job] = field(default_factory=list)
    running: Job | None = None

    @property
    def due(self) -> int | None:
        """When the running job's segment ends, if no event comes before."""
        return None if self.running is None else self.now + self.running.segments[0].left

    def advance(self, now: int) -> tuple[Job, JobStretch] | None:
        """Execute until ``now``, at most until `due`; the segment that has ended."""
        job = self.running
        spent, self.now = now - self.now, now
        if job is None or not spent:
            return None
        segment = job.segments[0]
        segment.left -= spent
        segment.begun = True
        if segment.left:
            return None
        job.segments.pop(0)
        if not job.segments:
            self.ready.remove(job)
            self.running = None
        return job, segment

    def release(self, job: Job) -> None:
        """Make a job ready that has something to execute."""
        self.ready.append(job)

    def dispatch(self) -> None:
        """Choose the job that runs from now on: of equals the running one, then the oldest."""
        self.running = max(
            self.ready,
            key=lambda job: (job.urgency()[:2], job is self.running, job.urgency()),
            default=None,
        )
