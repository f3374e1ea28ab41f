# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""When processors of a node are released together: by their offsets, over a whole cycle.

Release k of a periodic processor is due at the epoch + offset + k periods, and late by its
jitter at most. A time in which a processor waits for others can only begin where one of them
is released, so a certificate looks at these instants.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import System, Task

MOST = 200
"""Instants of one processor that a certificate lists at most."""

TRIED = 20_000
"""Releases in a cycle that are looked at for them at most."""


@dataclass(frozen=True, slots=True)
class Instant:
    """At ``time``, ns from the epoch, all is released that may be so late.

    ``release`` is the number of the processor's own first release from then on, or before.
    """

    time: Ns
    release: int


def has_offset(system: System, task: Task) -> bool:
    """Is it periodic, on a node where some processor has an offset, be its own zero or not?"""
    return (
        bool(task.slots)
        and not task.sporadic
        and any(other.offset for other in system.tasks if other.node == task.node)
    )


def phased(system: System, task: Task) -> tuple[Task, ...]:
    """The periodic processors of its core that ``task`` waits for, and itself; none if sporadic."""
    if task.sporadic or not task.slots:
        return ()
    return tuple(
        other
        for other in system.tasks
        if other.slots
        and not other.sporadic
        and (other.node, other.core) == (task.node, task.core)
        and other.priority >= task.priority
    )


def lateness(system: System, task: Task) -> Ns:
    """From its due time to the release of a periodic processor, at most."""
    tick = system.node(task.node).tick if task.timed else None
    return Ns(task.jitter + (tick.period if tick else 0))


def cycle_of(tasks: tuple[Task, ...]) -> Ns:
    """The time after which the releases of processors repeat, with their rows."""
    return Ns(math.lcm(*(slot.divisor * one.period for one in tasks for slot in one.slots)))


def instants(system: System, task: Task, reach: int) -> tuple[Instant, ...] | None:
    """The instants that are followed by a release of ``task`` in less than ``reach`` ns.

    They are of one cycle, after one in which all tasks are released. None where there are too
    many, or ``task`` has no offset.
    """
    tasks = phased(system, task)
    if not tasks:
        return None
    cycle = cycle_of(tasks)
    if sum(cycle // one.period for one in tasks) > TRIED:
        return None
    late = {one.element: lateness(system, one) for one in tasks}
    begun = max(late[one.element] + one.offset for one in tasks)
    base = -(-begun // cycle) * cycle + cycle
    times = {
        base + (one.offset + k * one.period + late[one.element]) % cycle
        for one in tasks
        for k in range(cycle // one.period)
    }
    found = []
    for time in sorted(times):
        release = -((task.offset + late[task.element] - time) // task.period)
        if task.offset + release * task.period - time < reach:
            found.append(Instant(Ns(time), release))
    return tuple(found) if len(found) <= MOST else None
