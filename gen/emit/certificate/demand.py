# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The demand in a window: the work of a task, its interference, and the platform's work."""

from __future__ import annotations

import math

from ravenchart.gen.emit.ada.expressions import Expr, number, plain
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.model.system import System, Task

from .interference import costs, of_tasks
from .terms import longest, name_of, plus, times


def switches(task: Task) -> Expr:
    """To a job and back, twice where it waits for its least separation as well."""
    return times(plain(4 if task.sporadic else 2), ref(f"{ada_case(task.node)}_Context_Switch"))


def sums(task: Task) -> dict[str, Expr]:
    """C of what every release executes, and C_n of the rows of every n-th release."""
    rows = [(slot.divisor, slot.element) for slot in task.slots] or [(1, task.element)]
    found: dict[str, Expr] = {}
    for divisor, name in costs(task).items():
        terms = [ref(f"{name_of(one)}_Wcet") for n, one in rows if n == divisor]
        found[name] = plus(*terms, switches(task)) if divisor == 1 else plus(*terms)
    return found


def work_of_jobs(task: Task, jobs: int) -> Expr:
    """The work of so many jobs in a row, from one that executes all rows on.

    Phases may keep rows out of one job; of that the longest counts.
    """
    if jobs == 1 and has_phases(task):
        return ref(f"{name_of(task.element)}_Longest")
    return plus(*(times(number(-(-jobs // n)), ref(c)) for n, c in costs(task).items()))


def has_phases(task: Task) -> bool:
    """Whether phases keep rows of a table apart."""
    return any(slot.phase for slot in task.slots)


def longest_of(task: Task, place: int | None = None) -> Expr:
    """The longest work of a release; until the row at a place, from 1, is done, where one is given.

    Then that row is executed, and of the rows before it those that the release executes as well.
    """
    slots = task.slots if place is None else task.slots[:place]
    if not has_phases(task):
        return plus(switches(task), *(ref(f"{name_of(slot.element)}_Wcet") for slot in slots))
    releases = range(math.lcm(*(slot.divisor for slot in task.slots)))
    found = dict.fromkeys(
        tuple(slot.element for slot in slots if k % slot.divisor == slot.phase)
        for k in releases
        if place is None or k % slots[-1].divisor == slots[-1].phase
    )
    whole = [one for one in found if not any(set(one) < set(other) for other in found)]
    sums = [plus(*(ref(f"{name_of(row)}_Wcet") for row in one)) for one in whole]
    return plus(switches(task), longest(sums))


def demand(system: System, task: Task, window: Expr, own: Expr) -> Expr:
    """The demand of the work ``own`` of a task within a window, with blocking and interference."""
    name = name_of(task.element)
    others = of_tasks(system, system.node(task.node), task.core).others(name, window)
    return plus(own, ref(f"{name}_B"), *others)
