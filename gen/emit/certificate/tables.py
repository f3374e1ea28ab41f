"""The facts that the code takes from the timing certificate: priorities and tables.

The sums of the certificate suppose an order of the tasks and a divisor for each row. So
the certificate also checks that its own facts say the same.
"""

from __future__ import annotations

from itertools import pairwise

from ravenchart.gen.emit.ada.syntax import Decl, Ref, number
from ravenchart.gen.model.system import Node, System, Task

from .terms import ONE, differs, name_of, plus, refuse, stated


def order(system: System, node: Node) -> list[Decl]:
    """The tasks of a node have the order of priority that their sums suppose."""
    tasks = sorted((t for t in system.tasks if t.node == node.name), key=lambda t: -t.priority)
    items: list[Decl] = []
    for high, low in pairwise(tasks):
        above, below = (Ref(f"{name_of(t.element)}_Priority") for t in (high, low))
        if high.priority == low.priority:
            problem = f"must have the priority of {low.element}"
            items.append(differs(above, below, high.element, problem))
        else:
            problem = f"must have a higher priority than {low.element}"
            items.append(refuse(plus(below, ONE), above, high.element, problem))
    return items


def table_terms(task: Task) -> list[Decl]:
    """When each row of a table executes; C and the sums beside it suppose its divisor."""
    if task.sporadic:
        return []
    items: list[Decl] = []
    for slot in task.slots:
        row = name_of(slot.element)
        divisor, phase = Ref(f"{row}_Divisor"), Ref(f"{row}_Phase")
        letter = "C" if slot.divisor == 1 else f"C_{slot.divisor}"
        problem = f"is in the sum {letter}, which its divisor contradicts"
        items += [
            stated(divisor.text, slot.divisor),
            stated(phase.text, slot.phase),
            differs(divisor, number(slot.divisor), slot.element, problem),
            refuse(plus(phase, ONE), divisor, slot.element, "has a phase beyond its divisor"),
        ]
    return items
