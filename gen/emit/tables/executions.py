# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Each row of a table is executed once: what its procedure says, and who calls it checks.

The procedure of a row leaves the row's number in a parameter that must be 0 before. So a
row that is called twice, not at all or in place of another one is not proved.
"""

from __future__ import annotations

from dataclasses import replace

from ravenchart.gen.emit.ada.declarations import Aspect, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import Expr, OperatorChain, equal, number
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.statements import Assign, Stmt
from ravenchart.gen.model.buses import Bus
from ravenchart.gen.model.system import Slot, System, Work

from .trace_calls import element_constant

ELEMENT_ID = ref("Ravenchart.Element_Id")
EXECUTED = Param("Executed", "in out", ELEMENT_ID)


def bus_row(system: System, bus: Bus, work: Work) -> Slot:
    """The row that does a bus's own work."""
    return next(s for s in system.slots if s.work is work and s.owner == bus.name)


def row_of(slot: Slot) -> Expr:
    """The number of a row."""
    return ref("Elements", element_constant(slot.element, "row"))


def run_spec(name: str, slot: Slot) -> Subprogram:
    """The procedure that executes a row once."""
    before = equal(ref("Executed"), number(0))
    after = equal(ref("Executed"), row_of(slot))
    return Subprogram(
        f"Run_{name}", (EXECUTED,), aspects=(Aspect("Pre", before), Aspect("Post", after))
    )


def executed(slot: Slot) -> Stmt:
    """Note in its body that the row is executed."""
    return Assign("Executed", OperatorChain("+", (ref("Executed"), row_of(slot))))


def executing(run: Subprogram, slot: Slot, *last: Stmt) -> Subprogram:
    """The body of a row's procedure, which notes that behind the ``last`` statements."""
    return replace(run, params=(EXECUTED,), body=(*(run.body or ()), *last, executed(slot)))
