# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules of behaviour: the situations that the charts of a model can and cannot reach.

`findings` checks each component by search and by z3. No finding calls something
impossible that is possible. Each finding of a possible situation has a way to it.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from ravenchart.behaviour.limits import EFFORT, UNFINISHED, Behaviour
from ravenchart.gen.derive.clients import clients
from ravenchart.gen.diagnostics import Diagnostic, in_order, warning
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.system import System

from .budget import Budget, Exhausted
from .control import RULES
from .inductive import contracts
from .invariants import NOT_PROVED, VIOLATED, invariants_hold
from .livelock import eventless_steps_end
from .outcomes import TooManyWays
from .protocols import protocol_followed
from .reach import Reachable


def behaviour(system: System, effort: int = EFFORT) -> Behaviour:
    """The findings on the behaviour of a valid model, and the invariants for its code.

    ``effort`` is that of the search; the contracts do not depend on it.
    """
    found = findings(system, effort)
    kept = contracts(system)
    open_ = {one.origin for one in found if one.code in (VIOLATED, NOT_PROVED)}
    more = (one for one in kept.found if one.origin not in open_)
    return Behaviour(in_order([*found, *more]), kept.regions)


def findings(system: System, effort: int = EFFORT) -> tuple[Diagnostic, ...]:
    """The findings on the behaviour of a valid model, in order of location."""
    budget = Budget(effort)
    found: list[Diagnostic] = []
    parts = [
        *((one, partial(_of_component, one)) for one in system.components),
        *((one.component, partial(protocol_followed, one)) for one in clients(system)),
    ]
    for component, rules in parts:
        try:
            for item in rules(system, budget):
                found.append(item)
        except Exhausted:
            looked = f"{budget.situations} situations took all the work that a check may take"
            found.append(_limit(component, looked))
            break
        except TooManyWays:
            found.append(_limit(component, "one of its steps has too many outcomes"))
    return in_order(found)


def _of_component(component: Component, system: System, budget: Budget) -> Iterator[Diagnostic]:
    reach = Reachable(component, system, budget)
    for thread in reach.threads:
        if thread.name in reach.published:
            for rule in (*RULES, eventless_steps_end):
                yield from rule(reach, thread)
    yield from invariants_hold(reach, system)


def _limit(component: Component, how_far: str) -> Diagnostic:
    message = f"the behaviour of {component.name} is not checked to the end: {how_far}"
    hint = "what is not reported may still be wrong; smaller regions are checked faster"
    return warning(UNFINISHED, component.origin, message, hint=hint)
