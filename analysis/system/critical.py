# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The critical instant of a task or frame as a schedule: the worst case behind its bound.

Every interfering job is released when the busy period begins, with its whole jitter. It is
released again as soon as it may be, or as its offset places it. The longest section of a
less urgent task has just begun. The schedule is as long, until the worst job is done, as the
response's window.
"""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heapify, heappop, heappush

from ravenchart.analysis.core.can_response import FrameResponse
from ravenchart.analysis.core.responses import Response, demand_of, release_time
from ravenchart.analysis.core.tasks import Task
from ravenchart.analysis.core.window import releases_in

GIVEN = "its given blocking"
"""The name of the blocking that is given besides the sections."""

MOST_JOBS = 400
"""A schedule of more jobs than this is not legible."""


@dataclass(frozen=True, slots=True)
class RunningSlice:
    """A part that runs without a break, in ticks from the beginning of the busy period."""

    name: str
    kind: str
    """``own``, ``blocking``, ``interference`` or ``overhead``."""
    start: int
    end: int


Job = tuple[int, int, int, str, str]
"""Release, precedence (least first), length, name and kind."""


def schedule(response: Response) -> tuple[RunningSlice, ...]:
    """The slices until the worst job is done; none without a bound, or of too many jobs."""
    if response.bound is None:
        return ()
    jobs = _jobs(response)
    if len(jobs) > MOST_JOBS:
        return ()
    found: list[RunningSlice] = []
    heapify(jobs)
    ready: list[tuple[int, int, int, str, str]] = []
    now = response.blocked
    section = 0 if response.blocking is None else response.blocking.length
    if response.blocking is not None:
        found.append(RunningSlice(response.blocking.user, "blocking", 0, section))
    if now > section:
        found.append(RunningSlice(GIVEN, "blocking", section, now))
    while jobs or ready:
        if not ready:
            now = max(now, jobs[0][0])
        while jobs and jobs[0][0] <= now:
            release, precedence, length, name, kind = heappop(jobs)
            heappush(ready, (precedence, release, length, name, kind))
        precedence, release, left, name, kind = heappop(ready)
        end = now + left if not jobs else min(now + left, max(now, jobs[0][0]))
        if end > now:
            _add(found, RunningSlice(name, kind, now, end))
        if end < now + left:
            heappush(ready, (precedence, release, now + left - end, name, kind))
        now = end
    return tuple(found)


def frame_schedule(response: FrameResponse) -> tuple[RunningSlice, ...]:
    """The same of a frame, until its worst instance is sent; no transmission is preempted.

    A frame takes part in an arbitration that begins less than a bit before it is queued.
    """
    if response.bound is None:
        return ()
    level, frame = response.level, response.frame
    jobs: list[Job] = [
        (time, 0, level.error_overhead, "errors", "overhead") for time in response.error_times
    ]
    for place, other in enumerate(level.order[: level.reach], 1):
        if other.name != frame.name:
            times = response.queued(other)
            jobs += [
                (time, place, other.transmission_time, other.name, "interference") for time in times
            ]
    first = response.lead - response.worst_instance * frame.period
    for instance in range(response.worst_instance + 1):
        time = max(0, first + instance * frame.period)
        jobs.append((time, level.reach + 1 + instance, frame.transmission_time, frame.name, "own"))
    if len(jobs) > MOST_JOBS:
        return ()
    now = response.blocked
    found = [RunningSlice(response.blocker or "another frame", "blocking", 0, now)] if now else []
    while jobs:
        ready = [job for job in jobs if job[0] <= now]
        job = min(ready, key=lambda job: (job[1], job[0])) if ready else min(jobs)
        jobs.remove(job)
        now = max(now, job[0])
        found.append(RunningSlice(job[3], job[4], now, now + job[2]))
        now += job[2]
    return tuple(found)


def _add(found: list[RunningSlice], piece: RunningSlice) -> None:
    """Add a slice, joined with the one before that it continues."""
    before = found[-1] if found else None
    if before and (before.name, before.kind, before.end) == (piece.name, piece.kind, piece.start):
        found[-1] = RunningSlice(piece.name, piece.kind, before.start, piece.end)
    else:
        found.append(piece)


def _jobs(response: Response) -> list[Job]:
    """All jobs released within the window, and the task's own jobs up to the worst one."""
    level, window = response.level, response.window
    platform = level.platform
    others = [task for task in level.order[: level.reach] if task.name != response.task.name]
    jobs: list[Job] = []
    for place, other in enumerate(others, 1):
        jobs += _released(other, response, place, "interference")
    own = demand_of(response.task, platform)
    count = response.worst_job + 1
    first = response.lead - response.worst_job * response.task.period
    for job in range(count):
        frame = (response.frame - response.worst_job + job) % len(own.wcets)
        time = max(0, first + job * response.task.period)
        jobs.append((time, len(others) + 1 + job, own.wcets[frame], response.task.name, "own"))
    if platform.tick_wcet:
        ticks = releases_in(window, platform.tick_period, 0)
        times = [n * platform.tick_period for n in range(ticks)]
        jobs += [(time, 0, platform.tick_wcet, "ticks and releases", "overhead") for time in times]
    for task in level.order if platform.release else ():
        for time in _times(task, response):
            jobs.append((time, 0, release_time(task, platform), "ticks and releases", "overhead"))
    return [job for job in jobs if job[2]]


def _times(task: Task, response: Response) -> list[int]:
    """The earliest releases of a task within the window."""
    return [time for time, _ in response.released(task)]


def _released(task: Task, response: Response, place: int, kind: str) -> list[Job]:
    """The jobs of an interfering task, with its known jobs of the cycle or the longest ones."""
    wcets = demand_of(task, response.level.platform).wcets
    return [(time, place, wcets[frame], task.name, kind) for time, frame in response.released(task)]
