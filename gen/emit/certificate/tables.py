"""The facts that the code takes from the timing certificate: priorities and tables.

The sums of the certificate suppose an order of the tasks and a divisor for each row. So
the certificate also checks that its own facts say the same.
"""

from __future__ import annotations

from itertools import pairwise

from ravenchart.gen.emit.ada.syntax import Decl, Expr, OperatorChain, Ref, number
from ravenchart.gen.model.nodes import Node
from ravenchart.gen.model.system import System, Task

from .interference import by_priority
from .terms import name_of, none_of, stated


def order(system: System, node: Node) -> list[Decl]:
    """The tasks of a node have the order of priority that their sums suppose."""
    wrong: list[Expr] = []
    for high, low in pairwise(by_priority(system, node)):
        above, below = (Ref(f"{name_of(t.element)}_Priority") for t in (high, low))
        wrong.append(OperatorChain("/=" if high.priority == low.priority else "<=", (above, below)))
    problem = "must keep the order of its priorities"
    return none_of(wrong, node.name, problem)


def table_terms(task: Task) -> list[Decl]:
    """When each row of a table executes; C and the sums beside it suppose its divisor."""
    if task.sporadic:
        return []
    items: list[Decl] = []
    wrong: list[Expr] = []
    for slot in task.slots:
        row = name_of(slot.element)
        divisor, phase = Ref(f"{row}_Divisor"), Ref(f"{row}_Phase")
        items += [stated(divisor.text, slot.divisor), stated(phase.text, slot.phase)]
        wrong.append(OperatorChain("/=", (divisor, number(slot.divisor))))
        late: Expr = OperatorChain(">=", (phase, divisor))
        wrong.append(OperatorChain("/=", (phase, number(0))) if slot.divisor == 1 else late)
    problem = "must keep divisors and phases of its rows"
    return items + none_of(wrong, task.element, problem)
