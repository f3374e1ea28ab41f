# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The facts that the code takes from the timing certificate: priorities and tables.

The sums of the certificate suppose an order of the tasks and a divisor for each row. So
the certificate also checks that its own facts say the same.
"""

from __future__ import annotations

from itertools import pairwise

from ravenchart.gen.emit.ada.declarations import Decl
from ravenchart.gen.emit.ada.expressions import Expr, OperatorChain, number
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import priority
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.model.nodes import Node
from ravenchart.gen.model.system import System, Task

from .certified import driver_element, timed_by
from .demand import has_phases
from .interference import by_priority
from .terms import name_of, named_number, none_of, stated


def driver_levels(system: System) -> list[Decl]:
    """The priority of each bus's driver, whatever it works at."""
    found = {t.driver_of: t.priority for t in system.tasks if t.driver_of is not None}
    items: list[Decl] = []
    for bus, level in found.items():
        items.append(Comment(f"[{bus}] the priority of the driver in all its work"))
        items.append(named_number(f"{name_of(driver_element(bus))}_Priority", priority(level)))
    return items


def level_of(task: Task) -> str:
    """The element whose priority a task has: a driver works at everything with its own."""
    return task.element if task.driver_of is None else driver_element(task.driver_of)


def order(system: System, node: Node, core: int) -> list[Decl]:
    """The tasks of a core have the order of priority that their sums suppose."""
    wrong: list[Expr] = []
    for high, low in pairwise(by_priority(system, node, core)):
        above, below = (ref(f"{name_of(level_of(t))}_Priority") for t in (high, low))
        if above == below:
            continue
        wrong.append(OperatorChain("/=" if high.priority == low.priority else "<=", (above, below)))
    problem = "must keep the order of its priorities"
    return none_of(wrong, node.core_name(core), problem)


def table_terms(task: Task) -> list[Decl]:
    """When each row of a table executes; C and the sums beside it suppose its divisor."""
    if task.sporadic:
        return []
    items: list[Decl] = []
    wrong: list[Expr] = []
    timed = {timed_by(task.element, task.slots, slot): slot for slot in task.slots}
    for element, slot in timed.items():
        own = name_of(element)
        divisor, phase = ref(f"{own}_Divisor"), ref(f"{own}_Phase")
        items += [stated(divisor, slot.divisor), stated(phase, slot.phase)]
        wrong.append(OperatorChain("/=", (divisor, number(slot.divisor))))
        late: Expr = OperatorChain(">=", (phase, divisor))
        known = slot.divisor == 1 or has_phases(task)  # the longest release is that of these phases
        wrong.append(OperatorChain("/=", (phase, number(slot.phase))) if known else late)
    problem = "must keep divisors and phases of its rows"
    return items + none_of(wrong, task.element, problem)
