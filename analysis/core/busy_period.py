# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The jobs of one task's busy period, one after another, under given interference."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .blocking import Section, held_up
from .multiframe import Demand
from .platform import Platform
from .responses import (
    Level,
    Reason,
    Response,
    RowResponse,
    demand_of,
    interference_of,
    jitter_of,
    switch_time,
)
from .tasks import Task
from .window import Effort, Source, Window, source

WHOLE = -1
"""In place of a row's number: the completion of the job."""

Goal = tuple[int, int, int]
"""A completion in a job: the time executed until then, the job in the table's cycle, the row."""


@dataclass(frozen=True, slots=True)
class Contender:
    """One task with the demand of its releases, overheads included, and its goals by time."""

    task: Task
    jitter: int
    demand: Demand
    source: Source
    serial: int
    goals: tuple[Goal, ...]

    @classmethod
    def of(cls, task: Task, platform: Platform, serial: int) -> Contender:
        """``task`` on that platform; ``serial`` is its unique number."""
        jitter, demand = jitter_of(task, platform), demand_of(task, platform)
        goals = [(work, frame, WHOLE) for frame, work in enumerate(demand.wcets)]
        if task.rows:
            before = task.wcet + switch_time(task, platform)
            goals += _row_goals(task, before)
            goals.sort()
        item = source(task.period, jitter, interference_of(task, platform))
        return cls(task, jitter, demand, item, serial, tuple(goals))

    @property
    def least(self) -> int:
        """The least execution time after which a row or the job is complete."""
        return self.goals[0][0]


def _row_goals(task: Task, before: int) -> list[Goal]:
    """The completion of each row in each job of the cycle; work apart from rows comes first."""
    number = {row.name: n for n, row in enumerate(task.rows)}
    goals = []
    for frame, rows in enumerate(task.frames):
        done = before
        for row in rows:
            done += row.wcet
            goals.append((done, frame, number[row.name]))
    return goals


@dataclass(slots=True)
class Worst:
    """The longest response found so far to one completion."""

    bound: int = -1
    job: int = 0
    frame: int = 0
    window: int = 0
    start: int = 0

    def note(self, bound: int, job: int, frame: int, window: int, start: int = 0) -> None:
        """Keep the first of the longest."""
        if bound > self.bound:
            self.bound, self.job, self.frame = bound, job, frame
            self.window, self.start = window, start


def response(
    own: Contender, level: Level, blocking: Section | None, window: Window, effort: Effort
) -> Response:
    """The response of ``own``; ``window`` holds the interference, at most that of its first job.

    Every job of the busy period is analysed, up to the one after which the releases
    of all tasks repeat. Later ones are no worse, as the load is at most 1.
    """
    task = own.task
    worst = {number: Worst() for number in range(WHOLE, len(task.rows))}
    blocked = held_up(task, blocking)
    several = len(own.goals) > 1
    repeat = math.inf
    job = 0
    while True:
        effort.left -= 1
        goals = _goals_of(own, job, blocked)
        settled = window.settle(goals[0][0], effort)
        at = window.fork() if several else window
        end = (job + 1) * task.period - own.jitter
        over = True
        for work, frame, number in goals:
            settled = settled and at.settle(work, effort)
            if number == WHOLE and at.length > end:
                over = False
            if number != WHOLE or own.demand.wcets[frame]:
                worst[number].note(
                    own.jitter + at.length - job * task.period, job, frame, at.length
                )
        if not settled or effort.left <= 0:
            return Response(task, level, blocking, None, reason=Reason.EFFORT)
        job += 1
        if job == 1 and not over:
            repeat = repeats_after(level, task.period, effort.left)
        if over or job >= repeat:
            return _found(own, level, blocking, worst, job)


def _goals_of(own: Contender, job: int, blocked: int) -> list[Goal]:
    """The goals of one job with the execution time of the jobs before it, by time."""
    if len(own.goals) == 1:
        work, frame, number = own.goals[0]
        return [(blocked + job * work + work, frame, number)]
    before = [blocked + own.demand.before(job, frame) for frame in range(len(own.demand.wcets))]
    return sorted((before[frame] + work, frame, number) for work, frame, number in own.goals)


def repeats_after(level: Level, period: int, limit: int) -> float:
    """Jobs after which the releases at a level repeat; infinity when above ``limit``."""
    platform = level.platform
    length = math.lcm(period, platform.tick_period or 1)
    tasks = level.order if platform.release else level.order[: level.reach]
    for task in tasks:
        length = math.lcm(length, task.period * task.frame_count)
        if length // period > limit:
            return math.inf
    return length // period


def _found(
    own: Contender, level: Level, blocking: Section | None, worst: dict[int, Worst], jobs: int
) -> Response:
    """The response of the job and of its rows."""
    task, whole = own.task, worst[WHOLE]
    rows = tuple(
        RowResponse(row, worst[n].bound, worst[n].job, worst[n].frame, worst[n].window)
        for n, row in enumerate(task.rows)
    )
    return Response(
        task, level, blocking, whole.bound, jobs, whole.job, whole.frame, whole.window, rows
    )
