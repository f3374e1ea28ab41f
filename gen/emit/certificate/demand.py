"""What a window must hold: the work of a task, of all that can delay it, and the platform's."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.syntax import Expr, Ref, number
from ravenchart.gen.model.system import System, Task

from .terms import ceiling, name_of, plus, times, within

Count = Callable[[Task, int], Expr]
"""How many of a task's releases that execute the rows of every n-th one are in a window."""


def switches(task: Task) -> Expr:
    """To a job and back, twice where it waits for its least separation as well."""
    return Ref(f"{4 if task.sporadic else 2} * {ada_case(task.node)}_Context_Switch")


def costs(task: Task) -> dict[str, Expr]:
    """C of what every release executes, and C_n of the rows of every n-th release."""
    if not task.slots:
        return {"C": plus(Ref(f"{name_of(task.element)}_Budget"), switches(task))}
    groups: dict[int, list[Expr]] = {1: []}
    for slot in task.slots:
        groups.setdefault(slot.divisor, []).append(Ref(f"{name_of(slot.element)}_Budget"))
    groups[1].append(switches(task))
    return {
        "C" if divisor == 1 else f"C_{divisor}": plus(*groups[divisor])
        for divisor in sorted(groups)
    }


def work(task: Task, count: Callable[[int], Expr]) -> Expr:
    """What releases of a task execute, of which ``count(n)`` execute the rows of every n-th."""
    own = name_of(task.element)
    terms = []
    for letter in costs(task):
        divisor = int(letter.partition("_")[2] or 1)
        terms.append(times(count(divisor), Ref(f"{own}_{letter}")))
    return plus(*terms)


def most(releases: Expr) -> Callable[[int], Expr]:
    """So many releases in a row, which begin with all rows at once."""
    return lambda divisor: releases if divisor == 1 else ceiling(releases, number(divisor))


def anyhow(window: Expr) -> Count:
    """The most that a window can hold, whenever it begins."""
    return lambda other, divisor: most(within(name_of(other.element), window))(divisor)


def demand(system: System, task: Task, window: Expr, own: Expr, count: Count | None = None) -> Expr:
    """What ``own`` work of a task needs within a window, with all that can delay it.

    Releases in the window are those of ``count``, or the most that it can hold.
    """
    node, counted = system.node(task.node), count or anyhow(window)
    terms = [own, Ref(f"{name_of(task.element)}_B")]
    for other in system.tasks:
        if other.node != task.node:
            continue
        if other is not task and other.priority >= task.priority:
            terms.append(work(other, partial(counted, other)))
        if node.release:
            ready = number(2 if other.sporadic else 1), Ref(f"{ada_case(node.name)}_Release")
            terms.append(times(counted(other, 1), *ready))
    if node.tick is not None and node.tick.wcet:
        tick = ada_case(node.name)
        terms.append(times(ceiling(window, Ref(f"{tick}_Tick_T")), Ref(f"{tick}_Tick_C")))
    return plus(*terms)
