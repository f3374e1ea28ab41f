# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""When the rows of an instance run: the k-th execution of a row, and those before it.

Every execution is assumed to take no time, so that it happens at its release: by
priority where several are released at once, in table order in one processor. A
real program may run so. So a trace that fits this schedule is feasible.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import z3

from ravenchart.gen.model.component import Component
from ravenchart.gen.model.system import System

from .logic import Term


@dataclass(frozen=True, slots=True)
class RowReleases:
    """A row's first release, its period in ns, and its turn among those released at once."""

    first: int
    period: int
    turn: int

    def executions_before(self, moment: Term, turn: int) -> Term:
        """How many executions come before a moment, in which it is the turn of another row."""
        passed = moment - self.first + (0 if self.turn < turn else -1)
        return z3.If(passed < 0, 0, passed / self.period + 1)

    def moment(self, execution: Term) -> Term:
        """When an execution happens; the first has number 0."""
        return self.first + execution * self.period


Rows = dict[str, RowReleases]


def schedules(system: System, component: Component) -> Iterator[tuple[str, Rows]]:
    """The rows of each instance that is allocated, by its name."""
    for instance in system.instances:
        if instance.component.name != component.name:
            continue
        slots = [
            (-processor.priority, index, processor, slot)
            for processor in system.processors
            for index, slot in enumerate(processor.slots)
            if slot.owner == instance.name and not slot.of_bus
        ]
        rows = {
            slot.name: RowReleases(
                processor.offset + slot.phase * processor.period,
                slot.divisor * processor.period,
                turn,
            )
            for turn, (_, _, processor, slot) in enumerate(sorted(slots, key=lambda s: s[:2]))
        }
        yield instance.name, rows


def in_one_table(system: System, component: Component, one: str, other: str) -> bool:
    """Whether two rows share a table in every instance, so that neither interrupts the other."""
    for instance in system.instances:
        if instance.component.name != component.name:
            continue
        names = {f"{instance.name}.{row}" for row in (one, other)}
        tables = [{slot.element for slot in p.slots} for p in system.processors]
        if not any(names <= table for table in tables):
            return False
    return True
