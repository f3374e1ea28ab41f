# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The phases that bring one task or message to its bound, where theory has such phases.

All interfering items are released together at one instant, each with its whole jitter, and
from then on without jitter. One tick before that instant the blocking section has been
entered, or one bit before, the blocking frame has begun. Where offsets are used, only the
jobs that can be released at that instant are.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from ravenchart.analysis.core.bus import Frame
from ravenchart.analysis.core.can_response import FrameResponse
from ravenchart.analysis.core.responses import Alignment, Response
from ravenchart.analysis.core.tasks import Task
from ravenchart.analysis.simulation.phases import Choice, InsideSection, Phase, PhaseScenario


@dataclass(frozen=True, slots=True)
class WorstCase:
    """A scenario, and the time that it must run until the worst completion."""

    scenario: PhaseScenario
    until: int


def of_task(response: Response) -> WorstCase:
    """The worst case of a task that has a bound; ValueError where it has none.

    It attains the bound, one tick of the blocking less, for tasks whose jobs are alike and
    whose priorities differ, unless the task's own job ends inside an object.
    """
    task = response.task
    if response.bound is None:
        raise ValueError(f"task {task.name} has no bound")
    if response.alignment is not None:
        return _of_aligned(response, response.alignment)
    level = response.level
    lead = 1 + max(other.jitter for other in level.order)
    frames = {share.task.name: share.frame for share in response.interference}
    frames[task.name] = (response.frame - response.worst_job) % task.frame_count
    phases = _together(level.order[: level.reach], lead, frames)
    for other in level.order[level.reach :]:
        phases[other.name] = Phase(_never(lead, response))
    blocking = response.blocking
    if blocking is not None and blocking.user in phases:
        phases[blocking.user] = Phase(lead - 1, inside=(InsideSection(0, blocking),))
    return WorstCase(PhaseScenario(phases), _never(lead, response))


def _of_aligned(response: Response, alignment: Alignment) -> WorstCase:
    """The worst case with offsets, so late in their pattern that all tasks have arrived."""
    task, level = response.task, response.level
    order = level.order[: level.reach]
    known = [other for other in order if response.uses_offset_of(other)]
    cycle = math.lcm(*(other.period * other.frame_count for other in known))
    begun = max((other.offset or 0) + 2 * other.jitter for other in order)
    start = alignment.start + -(-begun // cycle) * cycle
    frames = {share.task.name: share.frame for share in response.interference}
    frames[task.name] = (response.frame - response.worst_job) % task.frame_count
    phases = _together([other for other in order if other not in known], start, frames)
    for other in known:
        phases[other.name] = Phase(other.offset or 0, _until(start, other))
    until = start + response.window + 1
    for other in level.order[level.reach :]:
        phases[other.name] = Phase(until)
    return WorstCase(PhaseScenario(phases), until)


def _until(start: int, task: Task) -> Choice:
    """Jobs that can be released at ``start`` are; all others are not late."""
    offset, period, jitter = task.offset or 0, task.period, task.jitter

    def late(job: int) -> int:
        wait = start - offset - job * period
        return wait if 0 <= wait <= jitter else 0

    return late


def _never(lead: int, response: Response) -> int:
    """A time after the worst completion."""
    return lead + response.jobs * response.task.period + response.window + 1


def of_frame(response: FrameResponse) -> WorstCase:
    """The worst case of a frame that has a bound; ValueError where it has none.

    It attains the bound, one bit of the blocking less, without queues and errors.
    """
    frame, level = response.frame, response.level
    if response.bound is None:
        raise ValueError(f"message {frame.name} has no bound")
    lead = level.bus.bit_time + max(other.jitter for other in level.order)
    until = lead + response.instances * frame.period + response.window + frame.transmission_time
    phases = _together(level.order[: level.reach], lead, {})
    for other in level.order[level.reach :]:
        blocker = other.name == response.blocker
        phases[other.name] = Phase(lead - level.bus.bit_time if blocker else until + 1)
    return WorstCase(PhaseScenario(phases), until)


def _together(
    items: Iterable[Task | Frame], instant: int, frames: dict[str, int]
) -> dict[str, Phase]:
    """Phases in which all are released at the instant, as late as their jitter allows."""
    return {
        item.name: Phase(instant - item.jitter, _first_late(item), frame=frames.get(item.name, 0))
        for item in items
    }


def _first_late(item: Task | Frame) -> Choice:
    """Every job that can be is released with the first one; later ones are not late."""
    jitter, period = item.jitter, item.period
    return lambda job: max(0, jitter - job * period)
