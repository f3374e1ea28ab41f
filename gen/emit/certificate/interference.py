# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The interference of a task or a message within a window, as static functions.

Each step adds its demand to the function of the one before it. So the certificate grows with the
number of steps, not with its square.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby

from ravenchart.gen.emit.ada.declarations import Aspect, Decl, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import Call, Expr, arguments, call, number
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.model.nodes import Node
from ravenchart.gen.model.system import System, Task

from .terms import name_of, times

UNIT = ref("Ravenchart.Response_Times")
"""Holds the functions below: Time, Window, Sum and Demand."""

W = ref("W")
"""The parameter of each function."""


def demand_within(window: Expr, jitter: Expr, period: Expr, cost: Expr) -> Expr:
    """The demand of the releases within a window, the first as late as can be."""
    return call("Demand", window, jitter, period, cost)


@dataclass(frozen=True, slots=True)
class Interferer:
    """A task or message that delays others: its name, and its demand within W."""

    name: str
    terms: tuple[Expr, ...]
    level: int
    """Those of one level, who follow each other, delay each other."""


@dataclass(frozen=True, slots=True)
class Ladder:
    """Steps, the most urgent first, and their functions.

    The function of a step and of all before it is called ``up``, that of a step and of those
    behind it on its level ``rest``. ``base`` delays all of them.
    """

    steps: tuple[Interferer, ...]
    up: str = "Up"
    rest: str = "Rest"
    base: str = ""

    def _place(self, name: str) -> int:
        return next(n for n, step in enumerate(self.steps) if step.name == name)

    def _before(self, place: int, window: Expr) -> list[Expr]:
        found = f"{self.steps[place - 1].name}_{self.up}" if place else self.base
        return [call(found, window)] if found else []

    def others(self, name: str, window: Expr) -> list[Expr]:
        """The interference of a step within a window."""
        place = self._place(name)
        behind = self.steps[place + 1 : place + 2]
        alike = [s.name for s in behind if s.level == self.steps[place].level]
        return [
            *self._before(place, window),
            *(call(ref(f"{other}_{self.rest}"), window) for other in alike),
        ]

    def whole(self, name: str, window: Expr) -> list[Expr]:
        """The same, with the demand of the step itself."""
        level = self.steps[self._place(name)].level
        last = max(n for n, step in enumerate(self.steps) if step.level == level)
        return self._before(last + 1, window)

    def functions(self, *, last: bool = True) -> list[Decl]:
        """All that the others use; ``last``: that of the last step as well."""
        items: list[Decl] = []
        for place, step in enumerate(self.steps[: None if last else -1]):
            before = self._before(place, W)
            items.append(_function(f"{step.name}_{self.up}", step.terms, before))
        for _, level in groupby(self.steps, key=lambda step: step.level):
            later = list(level)[1:]
            behind: list[Expr] = []
            for step in reversed(later):
                name = f"{step.name}_{self.rest}"
                items.append(_function(name, step.terms, behind))
                behind = [call(name, W)]
        return items


def _function(name: str, terms: Sequence[Expr], more: Sequence[Expr] = ()) -> Decl:
    """The sum of the demands and of the other terms: each takes the rest with it."""
    *others, value = [*terms, *more]
    for term in reversed(others):
        assert isinstance(term, Call)
        value = Call(term.name, (*term.args, *arguments(value)))
    window = Param("W", "in", "Window")
    return Subprogram(name, (window,), "Time", (Aspect("Static"),), expression=value)


# --- Tasks ---------------------------------------------------------------------------


def costs(task: Task) -> dict[int, str]:
    """The names of a task's work: of the rows that every release executes, and every n-th."""
    own = name_of(task.element)
    divisors = sorted({1, *(slot.divisor for slot in task.slots)})
    return {n: f"{own}_C" if n == 1 else f"{own}_C_{n}" for n in divisors}


def _released(task: Task, divisor: int, cost: Expr) -> Expr:
    own = name_of(task.element)
    return demand_within(W, ref(f"{own}_J"), times(number(divisor), ref(f"{own}_T")), cost)


def by_priority(system: System, node: Node, core: int) -> list[Task]:
    """The tasks of a core, the most urgent first."""
    here = (t for t in system.tasks if (t.node, t.core) == (node.name, core))
    return sorted(here, key=lambda t: -t.priority)


def platform(
    system: System, node: Node, core: int, window: Expr, term: Callable[[Task, int, Expr], Expr]
) -> list[Expr]:
    """The time of a core's clock and of its tasks' releases, of which ``term`` counts some."""
    own = ada_case(node.name)
    found: list[Expr] = []
    if node.release:
        for task in by_priority(system, node, core):
            ready = times(number(1 + task.sporadic), ref(f"{own}_Release"))
            found.append(term(task, 1, ready))
    if node.tick is not None and node.tick.wcet:
        found.append(demand_within(window, number(0), ref(f"{own}_Tick_T"), ref(f"{own}_Tick_C")))
    return found


def of_tasks(system: System, node: Node, core: int) -> Ladder:
    """The tasks of a core."""
    steps = (
        Interferer(
            name_of(task.element),
            tuple(_released(task, divisor, ref(c)) for divisor, c in costs(task).items()),
            task.priority,
        )
        for task in by_priority(system, node, core)
    )
    base = f"{name_of(node.core_name(core))}_Platform"
    return Ladder(tuple(steps), base=base if platform(system, node, core, W, _released) else "")


def task_functions(system: System, node: Node, core: int) -> list[Decl]:
    """The functions of a core: those of its platform, and those of its tasks."""
    ladder = of_tasks(system, node, core)
    given = platform(system, node, core, W, _released)
    own = [_function(ladder.base, given)] if ladder.base else []
    return [*own, *ladder.functions(last=False)]
