# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Responses of tasks that one clock releases, each at its own offset from an epoch.

Release k of a task with the offset O is due at O + k T, so it is known which releases meet.
The worst busy period of a job begins where a job of its level is released as late as its
jitter allows. A busy period that begins between two such instants could begin later with the
same jobs in it. So these instants are tried, over one cycle of all the offsets and tables.
From the instant t on, for job q of the busy period, which arrives at a(q),

    w(q) = B + own(q) + sum over tasks with offsets of  C of jobs in [t - J_j, t + w(q))
             + sum over the others of  most_j(ceil((J_j + w(q)) / T_j))
    R    = max over t and q of  t + w(q) - a(q)

Tindell, Adding time-offsets to schedulability analysis (YCS 221, 1994); Palencia and
Gonzalez Harbour, RTSS 1998, whose exact form this is where the tasks of a core are one
transaction. Of several epochs (transactions) the one counts that makes a response shortest;
tasks of the others may be released at any time between. Jobs of a table count with the rows
of their own release. The bound is attained without sections, equal priorities, tables of
unknown phase and further epochs. It is never above the bound for all offsets. That bound is
the result where the work allowed does not suffice.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import accumulate

from .busy_period import WHOLE, Contender, Goal, Worst, repeats_after
from .multiframe import Demand
from .platform import Platform
from .responses import (
    Alignment,
    Response,
    RowResponse,
    demand_of,
    jitter_of,
    release_time,
    stream_of,
)
from .streams import Stream
from .tasks import Task
from .window import Effort, Source, constant_source, execution_of, source

INSTANTS = 10_000
"""Instants that are tried for one task at most; offsets that lead to more are left out."""


class _Arrivals:
    """The arrivals of several streams over their common cycle, and their demand up to each."""

    def __init__(self, streams: Sequence[Stream], cycle: int) -> None:
        self.streams = streams
        self.cycle = cycle
        arrivals = sorted(one for stream in streams for one in stream.arrivals(cycle))
        self.times = [time for time, _ in arrivals]
        self.sums = list(accumulate((wcet for _, wcet in arrivals), initial=0))

    def before(self, end: int) -> int:
        """The demand that arrives before ``end``, counted from a common instant."""
        cycles, rest = divmod(end, self.cycle)
        return cycles * self.sums[-1] + self.sums[bisect_left(self.times, rest)]

    def late(self, start: int) -> int:
        """The demand that arrives before ``start`` and may be released from ``start`` on."""
        return sum(s.execution(start - s.jitter, start) for s in self.streams if s.jitter)

    def instants(self) -> Iterator[int]:
        """The instants at which the streams release jobs as late as possible."""
        for stream in self.streams:
            for time, _ in stream.arrivals(self.cycle):
                yield (time + stream.jitter) % self.cycle


def _released(task: Task, platform: Platform) -> Stream:
    """The stream of the work that makes the jobs of a task ready."""
    return replace(stream_of(task, platform), demand=Demand((release_time(task, platform),)))


def aligned(response: Response, epoch: str = "") -> tuple[Task, ...]:
    """The tasks of its level whose offsets from an epoch are used: at least two, or none.

    Short cycles come first, so that the choice depends on the set of tasks alone. A search
    for an order needs a choice that does not depend on priorities.
    """
    known = _of(epoch, response.level.order[: response.level.reach])
    known.sort(key=lambda task: (task.period * task.frame_count, task.period, task.name))
    found: list[Task] = []
    cycle, count = 1, 0
    for task in known:
        longer = math.lcm(cycle, task.period * task.frame_count)
        more = count * (longer // cycle) + longer // task.period
        if more <= INSTANTS:
            found.append(task)
            cycle, count = longer, more
    return tuple(found) if len(found) > 1 else ()


def closer(
    found: Iterable[Response], order: Sequence[Task], platform: Platform, effort: Effort
) -> Iterator[Response]:
    """The responses of tasks of one core with their offsets used; ``found`` holds for all.

    A response stays as it is where offsets make it no shorter, or the effort does not suffice.
    """
    known = {t.epoch: _of(t.epoch, order) for t in order if t.offset is not None}
    apart = {epoch for epoch, some in known.items() if len(some) > 1}
    together = {epoch for epoch in apart if _together(known[epoch], platform)}
    for plain in found:
        task, best = plain.task, plain
        for epoch in sorted(apart):
            inside = task.offset is not None and task.epoch == epoch
            met = epoch in together and (plain.jobs == 1 or not inside)
            if met or plain.bound is None or effort.left <= 0:
                continue
            tasks = aligned(plain, epoch)
            tried = OffsetSearch(plain, tasks, effort).found() if tasks else plain
            if tried.bound is not None and (best.bound is None or tried.bound <= best.bound):
                best = tried  # where the job is no sooner done, its rows may be
        yield best


def _of(epoch: str, tasks: Iterable[Task]) -> list[Task]:
    """The tasks with offsets from an epoch."""
    return [task for task in tasks if task.offset is not None and task.epoch == epoch]


def _together(tasks: Sequence[Task], platform: Platform) -> bool:
    """Whether all begin at once, equally late, with all rows: the first job is then the worst."""
    begins = {(task.offset, jitter_of(task, platform)) for task in tasks}
    return len(begins) < 2 and not any(row.phase for task in tasks for row in task.rows)


class OffsetSearch:
    """The instants of one task, tried in the order of the responses that they can lead to."""

    def __init__(self, plain: Response, tasks: Sequence[Task], effort: Effort) -> None:
        self.plain, self.effort = plain, effort
        self.level, platform = plain.level, plain.level.platform
        self.own = Contender.of(plain.task, platform, 0)
        self.names = frozenset(task.name for task in tasks)
        self.stream = stream_of(plain.task, platform) if plain.task in tasks else None
        streams = [stream_of(task, platform) for task in tasks if task is not plain.task]
        if platform.release:
            streams += [_released(task, platform) for task in tasks]
        cycle = math.lcm(*(task.period * task.frame_count for task in tasks))
        self.interference = _Arrivals(streams, cycle)
        effort.left -= len(self.interference.times)
        self.others = list(self._others(platform))
        self.worst = {number: Worst() for number in range(WHOLE, len(plain.task.rows))}
        assert plain.bound is not None
        self.limits = {WHOLE: plain.bound, **{n: r.bound for n, r in enumerate(plain.rows)}}
        self.jobs = 0
        self.pattern = math.inf

    def _others(self, platform: Platform) -> Iterator[Source]:
        """The sources without an offset: other tasks, ticks, and releases of less urgent tasks."""
        for task in self.level.order[: self.level.reach]:
            if task.name not in self.names and task.name != self.plain.task.name:
                yield source(task.period, jitter_of(task, platform), demand_of(task, platform))
        if platform.tick_wcet:
            yield constant_source(platform.tick_period, 0, platform.tick_wcet)
        for task in self.level.order if platform.release else ():
            if task.name not in self.names:
                wcet = release_time(task, platform)
                yield constant_source(task.period, jitter_of(task, platform), wcet)

    def found(self) -> Response:
        """The longest response over all instants."""
        for lead, start in self._instants():
            if self._attained(self.own.jitter + lead):
                break
            self._try(start, lead)
            if self.effort.left <= 0:
                return self.plain
        if self._attained(0):
            return self.plain
        whole = self.worst[WHOLE]
        rows = tuple(
            RowResponse(row, self.worst[n].bound, self.worst[n].job, self.worst[n].frame,
                        self.worst[n].window)
            for n, row in enumerate(self.plain.task.rows)
        )  # fmt: skip
        return replace(
            self.plain, bound=whole.bound, jobs=self.jobs, worst_job=whole.job, frame=whole.frame,
            window=whole.window, rows=rows,
            alignment=Alignment(whole.start, whole.window - whole.bound, self.names),
        )  # fmt: skip

    def followed(self, reach: int) -> list[tuple[int, int]]:
        """The instants of a cycle less than ``reach`` before an arrival of the task, in order.

        Each has the time from it to that arrival, below 0 where the arrival was before.
        """
        return sorted((start, lead) for lead, start in self._instants() if lead < reach)

    def window(self, start: int) -> int | None:
        """The time from ``start`` until the first job is done that arrives then, less its jitter.

        It counts from ``start`` on, even where all work is done before the job arrives. None
        without an offset of the task, or without effort.
        """
        if self.stream is None:
            return None
        first = self.stream.number(start - self.own.jitter)
        wcet = self.own.demand.wcets[first % len(self.own.demand.wcets)]
        counted = self.interference.late(start) - self.interference.before(start)
        found = self._settled(self.plain.blocked + wcet, start, counted, 1)
        return found if self.effort.left > 0 else None

    def _attained(self, less: int) -> bool:
        """Whether each response found is at least its bound for all offsets minus ``less``."""
        return all(worst.bound >= self.limits[n] - less for n, worst in self.worst.items())

    def _instants(self) -> list[tuple[int, int]]:
        """The instants, each after the time from it to the first arrival of the task's own job.

        The nearer this arrival, the longer the response can be.
        """
        late, stream = self.own.jitter, self.stream
        starts = set(self.interference.instants())
        if stream is None:
            return [(-late, start) for start in sorted(starts)]
        cycle = self.interference.cycle
        starts |= {(time + late) % cycle for time, _ in stream.arrivals(cycle)}
        return sorted(((stream.offset - start + late) % stream.period - late, start)
                      for start in starts)  # fmt: skip

    def _try(self, start: int, lead: int) -> None:
        """The responses of all jobs of the busy period that begins at ``start``."""
        task, own, stream = self.plain.task, self.own, self.stream
        counted = self.interference.late(start) - self.interference.before(start)
        first = 0 if stream is None else stream.number(start + lead)
        blocked, job, length = self.plain.blocked, 0, 1
        if lead > 0:
            length = self._settled(blocked, start, counted, length)
            if length <= lead:
                return
        while self.effort.left > 0:
            over = True
            arrival = lead + job * task.period
            windows = []
            for work, frame, number in self._goals(job, first):
                windows.append(window := self._settled(blocked + work, start, counted, length))
                if number == WHOLE and window > arrival + task.period:
                    over = False
                if number != WHOLE or own.demand.wcets[frame]:
                    self.worst[number].note(window - arrival, job, frame, window, start)
            length = min(windows)
            job += 1
            self.jobs = max(self.jobs, job)
            if job == 1 and not over and self.pattern == math.inf:
                self.pattern = repeats_after(self.level, task.period, self.effort.left)
            if over or job >= self.pattern:
                return

    def _goals(self, job: int, first: int) -> Iterator[Goal]:
        """The completions in a job, each with the time executed until then since the first job.

        If the task's offset is used, its job of the cycle is known; else it may be any.
        """
        demand = self.own.demand
        known = None if self.stream is None else (first + job) % len(demand.wcets)
        for work, frame, number in self.own.goals:
            if known is None or frame == known:
                yield demand.before(job, frame) + work, frame, number

    def _settled(self, fixed: int, start: int, counted: int, length: int) -> int:
        """The least window from ``length`` on that holds ``fixed`` and the demand in it.

        The length reached so far, where the effort does not suffice.
        """
        interference, others = self.interference, self.others
        while True:
            self.effort.left -= 1 + len(others) // 4
            needed = fixed + counted + interference.before(start + length)
            for item in others:
                needed += execution_of(item, -(-(length + item[1]) // item[0]))
            if needed <= length or self.effort.left <= 0:
                return length
            length = needed
