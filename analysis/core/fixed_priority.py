# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Worst-case response times of preemptive tasks under fixed priorities.

For job q (from 0) of a busy period of the task's level, ending in frame f:

    w(q, f) = B + own(q, f) + sum over others of most_j(ceil((J_j + w) / T_j))
    R       = max over q and f of  J + w(q, f) - q T

The others are the tasks of the core with higher or equal priority; own is the
execution time of the job and of the q before it. Joseph and Pandya 1986; Audsley et al.
1993; Lehoczky 1990 for deadlines beyond the period; Tindell, Burns, Wellings 1994
for jitter. With one C per task, no sections and no equal priorities the bound
is attained by some phasing. It is safe, and may not be attained, for equal
priorities (each counts in full) and for multiframe tasks (each is at its
worst in every window). R counts from the arrival and includes the task's own jitter.
It holds for all offsets. Where they are known, `offsets` finds the shorter responses.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import groupby
from operator import attrgetter

from .blocking import Section, blockers, held_up
from .busy_period import Contender, response
from .checks import distinct
from .kernel import WORTH_IT, busy_periods
from .offsets import closer
from .platform import Platform
from .responses import Level, Reason, Response, jitter_of, release_time, switch_time
from .tasks import Task
from .window import Effort, Load, Window, constant_source

TASK_EFFORT = 200_000
"""Changes of release numbers that one task's analysis may take; then it has no bound."""

WHOLE_EFFORT = 5_000_000
"""The same for one call: later tasks have no bound either."""

OFFSETS_EFFORT = 500_000
"""Steps of windows from chosen instants in one call: later bounds hold for all offsets."""

NO_OVERHEAD = Platform()

OVERHEADS_FROM = 1 << 40
"""Serial numbers of overheads; those of tasks are below."""


def analyse_tasks(
    tasks: Sequence[Task],
    sections: Sequence[Section] = (),
    platforms: Mapping[str, Platform] | None = None,
    ceilings: Mapping[str, int] | None = None,
) -> tuple[Response, ...]:
    """The worst-case response of every task, in the order given.

    Tasks of different cores do not meet. ``platforms`` has the overheads of a
    core by its name, ``ceilings`` the ceilings that are not just the highest
    priority of the users. ValueError for a name given twice, and as `blockers`.
    """
    effort, steps = Effort(WHOLE_EFFORT), Effort(OFFSETS_EFFORT)
    held = blockers(tasks, sections, ceilings)
    found: dict[str, Response] = {}
    for core, order in _cores(tasks).items():
        platform = (platforms or {}).get(core, NO_OVERHEAD)
        responses = closer(_core(order, held, platform, effort), order, platform, steps)
        found |= {one.task.name: one for one in responses}
    return tuple(found[task.name] for task in tasks)


def bounds(
    tasks: Sequence[Task],
    sections: Sequence[Section] = (),
    platforms: Mapping[str, Platform] | None = None,
    ceilings: Mapping[str, int] | None = None,
) -> tuple[int | None, ...]:
    """The bounds that `analyse` finds, without their terms: for searches that ask often."""
    held = blockers(tasks, sections, ceilings) if sections else {}
    found: dict[str, int] = {}
    for core, order in _cores(tasks).items():
        lengths = _quickly(order, held, (platforms or {}).get(core, NO_OVERHEAD))
        if not lengths or not all(lengths):
            return tuple(r.bound for r in analyse_tasks(tasks, sections, platforms, ceilings))
        found.update(zip([task.name for task in order], lengths, strict=True))
    return tuple([found[task.name] for task in tasks])


def _cores(tasks: Sequence[Task]) -> dict[str, tuple[Task, ...]]:
    """The tasks of each core, most urgent first; ValueError for a name given twice."""
    distinct("tasks", [task.name for task in tasks])
    cores: dict[str, list[Task]] = {}
    for task in tasks:
        cores.setdefault(task.core, []).append(task)
    urgency = attrgetter("priority")
    return {c: tuple(sorted(mine, key=urgency, reverse=True)) for c, mine in cores.items()}


def _quickly(order: tuple[Task, ...], held: Mapping[str, Section], platform: Platform) -> list[int]:
    """The bounds of plain tasks whose first job ends the busy period, 0 for others.

    An empty list where the library does not help: for few tasks, or overheads above all tasks.
    """
    if len(order) < WORTH_IT or platform.release or platform.tick_wcet:
        return []
    for task in order:
        if task.jitter or task.rows or task.timed or task.offset is not None:
            return []
    wcets = [task.wcet for task in order]
    if platform.context_switch:
        wcets = [task.wcet + switch_time(task, platform) for task in order]
    blocked = [held_up(task, held.get(task.name)) for task in order]
    last = {task.priority: number for number, task in enumerate(order)}
    return busy_periods(
        [task.period for task in order], wcets, [last[task.priority] for task in order], blocked
    )


def response_under(
    task: Task,
    interfering: Sequence[Task],
    bystanders: Sequence[Task] = (),
    blocking: Section | None = None,
    platform: Platform = NO_OVERHEAD,
) -> Response:
    """The response of ``task`` with the interference of all ``interfering`` tasks.

    Priorities do not count. Of the ``bystanders``, which are less urgent, only releases take time.
    """
    level = Level((*interfering, task, *bystanders), len(interfering) + 1, platform)
    own = Contender.of(task, platform, 0)
    others = [Contender.of(other, platform, n) for n, other in enumerate(interfering, 1)]
    window, load = _beginning(level.order, platform)
    for item in (own, *others):
        load.add(item.source)
    if load.above_one(_exactly(level)):
        return Response(task, level, blocking, None, reason=Reason.OVERLOAD)
    for item in others:
        window.add(item.serial, item.source)
    found = response(own, level, blocking, window, Effort(TASK_EFFORT))
    return next(closer([found], level.order, platform, Effort(OFFSETS_EFFORT)))


def _beginning(tasks: Sequence[Task], platform: Platform) -> tuple[Window, Load]:
    """A window that holds the overheads above all ``tasks`` of a core."""
    window, load = Window(), Load()
    sources = []
    if platform.tick_wcet:
        sources.append(constant_source(platform.tick_period, 0, platform.tick_wcet))
    if platform.release:
        for task in tasks:
            jitter = jitter_of(task, platform)
            sources.append(constant_source(task.period, jitter, release_time(task, platform)))
    for number, item in enumerate(sources):
        window.add(OVERHEADS_FROM + number, item)
        load.add(item)
    return window, load


def _core(
    order: tuple[Task, ...], held: Mapping[str, Section], platform: Platform, effort: Effort
) -> Iterator[Response]:
    """The responses of the tasks of one core, which come most urgent first."""
    quick = _quickly(order, held, platform)
    if quick and all(quick):
        last = {task.priority: number for number, task in enumerate(order, 1)}
        for task, length in zip(order, quick, strict=True):
            level = Level(order, last[task.priority], platform)
            yield Response(task, level, held.get(task.name), length, jobs=1, window=length)
        return
    base, load = _beginning(order, platform)
    reach = 0
    reason: Reason | None = None
    for _, group in groupby(order, key=lambda task: task.priority):
        members = [Contender.of(task, platform, reach + n) for n, task in enumerate(group)]
        reach += len(members)
        level = Level(order, reach, platform)
        for item in members:
            load.add(item.source)
        if reason is None and load.above_one(_exactly(level)):
            reason = Reason.OVERLOAD
        if reason is None and not base.settle(sum(i.least for i in members), effort):
            reason = Reason.EFFORT
        if reason is not None:
            yield from (
                Response(item.task, level, held.get(item.task.name), None, reason=reason)
                for item in members
            )
            continue
        yield from _group(members, level, held, base, effort)


def _exactly(level: Level) -> Callable[[], Fraction]:
    """The load of a level, worked out only when it is asked for."""
    return lambda: level.load


def _group(
    members: Sequence[Contender],
    level: Level,
    held: Mapping[str, Section],
    base: Window,
    effort: Effort,
) -> Iterator[Response]:
    """The responses of tasks of one priority, which are then part of ``base``."""
    alone = len(members) == 1
    start = base.fork() if alone else base
    for item in members:
        base.add(item.serial, item.source)
    for item in members:
        if not alone:
            start = base.fork()
            start.leave_out(item.serial, item.source)
        allowed = Effort(min(TASK_EFFORT, effort.left))
        before = allowed.left
        yield response(item, level, held.get(item.task.name), start, allowed)
        effort.left -= before - allowed.left
