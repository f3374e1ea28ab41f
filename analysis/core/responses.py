# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The response of a task, and every term that it is made of."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from fractions import Fraction

from .blocking import Section, held_up
from .multiframe import Demand
from .platform import Platform
from .streams import Stream
from .tasks import TableRow, Task, without_phases
from .window import execution_of, releases_in, source


class Reason(Enum):
    """Why a response has no bound."""

    OVERLOAD = "what runs at its level needs more than all of the resource"
    EFFORT = "none was found within the work allowed"
    DELAYED = "something that delays it has no bound itself"


@dataclass(frozen=True, slots=True)
class Interference:
    """The interference of one other task; its first release has job ``frame`` of its cycle."""

    task: Task
    releases: int
    frame: int
    time: int


@dataclass(frozen=True, slots=True)
class Overheads:
    """Time in the window outside all tasks: switches of all its jobs, ticks, releases."""

    switches: int
    switch_time: int
    ticks: int
    tick_time: int
    releases: int
    release_time: int

    @property
    def time(self) -> int:
        """All overheads together."""
        return self.switch_time + self.tick_time + self.release_time


@dataclass(frozen=True, slots=True)
class Level:
    """The tasks of a level: the first ``reach`` of its core's tasks, most urgent first."""

    order: tuple[Task, ...]
    reach: int
    platform: Platform

    @property
    def load(self) -> Fraction:
        """Share of the core that these tasks and the overheads need."""
        platform = self.platform
        load = Fraction(platform.tick_wcet, platform.tick_period or 1)
        for task in self.order:
            load += Fraction(release_time(task, platform), task.period)
        for task in self.order[: self.reach]:
            demand = interference_of(task, platform)
            load += Fraction(demand.total, len(demand.wcets) * task.period)
        return load


@dataclass(frozen=True, slots=True)
class Alignment:
    """The place in the pattern of known offsets at which a response is longest.

    The busy period begins at ``start`` (ticks from the epoch of all offsets, or some cycles
    later). The worst job arrives ``lead`` later, or before, by its jitter. ``tasks``
    are those whose offsets were used.
    """

    start: int
    lead: int
    tasks: frozenset[str]


@dataclass(frozen=True, slots=True)
class RowResponse:
    """The longest time from the arrival of a job to the completion of one of its rows.

    It is attained by job ``job`` of a busy period, which is job ``frame`` of the cycle.
    """

    row: TableRow
    bound: int
    job: int
    frame: int
    window: int


@dataclass(frozen=True, slots=True)
class Response:
    """The worst-case response of one task; all times in ticks.

    ``bound`` counts from the arrival, or is None with the ``reason``. It is attained
    by job ``worst_job`` (from 0) of a busy period, which is job ``frame`` of the cycle of
    the task's table. ``jobs`` were analysed: all of the busy period, or those after which
    the releases of all tasks repeat. The bound is made of

        window - lead = bound
        blocked + own + interference + overheads = window

    with ``lead`` from the beginning of the busy period to the arrival of the worst job:
    worst_job * period - jitter, unless offsets make it shorter. In this case there is an
    ``alignment``; without one the bound holds for all offsets.
    """

    task: Task
    level: Level
    blocking: Section | None
    bound: int | None
    jobs: int = 0
    worst_job: int = 0
    frame: int = 0
    window: int = 0
    rows: tuple[RowResponse, ...] = ()
    reason: Reason | None = None
    alignment: Alignment | None = None

    @property
    def met(self) -> bool:
        """The bound exists and is at most the deadline."""
        return self.bound is not None and self.bound <= self.task.deadline

    @property
    def slack(self) -> int | None:
        """Deadline less bound; negative when missed, None without a bound."""
        return None if self.bound is None else self.task.deadline - self.bound

    @property
    def jitter(self) -> int:
        """The latest release after the arrival: the task's own jitter and the tick's period."""
        return jitter_of(self.task, self.level.platform)

    @property
    def lead(self) -> int:
        """From the beginning of the busy period to the arrival of the worst job."""
        if self.alignment is not None:
            return self.alignment.lead
        return self.worst_job * self.task.period - self.jitter

    @property
    def late(self) -> int:
        """How long after its arrival the busy period's first job is released."""
        return max(0, self.worst_job * self.task.period - self.lead)

    @property
    def blocked(self) -> int:
        """B: the longest section of a less urgent task, and the given ``held``; counts once."""
        return held_up(self.task, self.blocking)

    @property
    def own(self) -> int:
        """The execution time of the worst job and of those before it in the busy period."""
        demand = demand_of(self.task, Platform())
        return demand.before(self.worst_job, self.frame) + demand.wcets[self.frame]

    @property
    def interference(self) -> tuple[Interference, ...]:
        """The interference of each other task of the level in the window, longest first."""
        if self.bound is None:
            return ()
        found = [self._taken_by(other) for other in self._others()]
        found = [share for share in found if share.releases]
        return tuple(sorted(found, key=lambda share: -share.time))

    @property
    def overheads(self) -> Overheads:
        """Switches, ticks and releases within the window."""
        platform = self.level.platform
        if self.bound is None:
            return Overheads(0, 0, 0, 0, 0, 0)
        own = (self.worst_job + 1) * self.task.suspensions
        switched = own + sum(self._releases(t) * t.suspensions for t in self._others())
        ticks = releases_in(self.window, platform.tick_period, 0) if platform.tick_period else 0
        released = 0
        if platform.release:
            released = sum(self._releases(task) * task.suspensions for task in self.level.order)
        return Overheads(
            2 * switched,
            2 * switched * platform.context_switch,
            ticks,
            ticks * platform.tick_wcet,
            released,
            released * platform.release,
        )

    def _others(self) -> list[Task]:
        order = self.level.order[: self.level.reach]
        return [task for task in order if task.name != self.task.name]

    def _releases(self, task: Task) -> int:
        platform = self.level.platform
        if self.uses_offset_of(task):
            return stream_of(task, platform).count(*self._span(task))
        return releases_in(self.window, task.period, jitter_of(task, platform))

    def released(self, task: Task) -> list[tuple[int, int]]:
        """The earliest releases of ``task`` in the window, each with its job of the cycle."""
        platform = self.level.platform
        count, jitter = self._releases(task), jitter_of(task, platform)
        demand = demand_of(task, platform)
        first, since = demand.first(count), -jitter
        if self.alignment is not None and self.uses_offset_of(task):
            stream = stream_of(task, platform)
            first = stream.number(self.alignment.start - jitter)
            since = stream.offset + first * task.period - self.alignment.start
        frames = len(demand.wcets)
        return [(max(0, since + n * task.period), (first + n) % frames) for n in range(count)]

    def uses_offset_of(self, task: Task) -> bool:
        """Whether the jobs of ``task`` count as its offset places them."""
        return self.alignment is not None and task.name in self.alignment.tasks

    def _span(self, task: Task) -> tuple[int, int]:
        """The span in which jobs of the window arrive, of a task whose offset is used."""
        start = self.alignment.start if self.alignment else 0
        return start - jitter_of(task, self.level.platform), start + self.window

    def _taken_by(self, other: Task) -> Interference:
        """The interference of ``other``, with its known jobs of the cycle or the longest ones."""
        count, platform = self._releases(other), self.level.platform
        demand = interference_of(other, platform)
        switches = count * switch_time(other, platform)
        if self.uses_offset_of(other):
            stream, span = stream_of(other, platform), self._span(other)
            frame = stream.number(span[0]) % len(demand.wcets)
            return Interference(other, count, frame, stream.execution(*span) - switches)
        item = source(other.period, 0, demand)
        return Interference(other, count, demand.first(count), execution_of(item, count) - switches)


def jitter_of(task: Task, platform: Platform) -> int:
    """The latest release of ``task`` after its arrival on that platform."""
    return task.jitter + (platform.tick_period if task.timed else 0)


def switch_time(task: Task, platform: Platform) -> int:
    """The context switches of one job: to it and back, each time that it suspends itself."""
    return 2 * task.suspensions * platform.context_switch


def release_time(task: Task, platform: Platform) -> int:
    """The time above all tasks to make one job ready, each time that it suspends itself."""
    return task.suspensions * platform.release


def demand_of(task: Task, platform: Platform) -> Demand:
    """The demand of the releases of ``task``, each with its context switches."""
    extra = task.wcet + switch_time(task, platform)
    if not task.rows:
        return Demand((extra,))
    return Demand(tuple(extra + sum(row.wcet for row in rows) for rows in task.frames))


def interference_of(task: Task, platform: Platform) -> Demand:
    """The demand of the releases of ``task`` as others count it."""
    return demand_of(without_phases(task) if task.summed else task, platform)


def stream_of(task: Task, platform: Platform) -> Stream:
    """The jobs of a task that has an offset, with their context switches."""
    return Stream(
        task.offset or 0, task.period, jitter_of(task, platform), demand_of(task, platform)
    )
