# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules for what `record` names: it can be recorded, and is recorded once."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.model.component import Data, Direction
from ravenchart.gen.model.recording import RecordedItem
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.resolve.system import Resolved


def recorded_items_have_values(resolved: Resolved) -> Iterator[Diagnostic]:
    """Something gives a recorded item its values."""
    for one in resolved.system.recorded:
        component = resolved.system.instance(one.instance).component
        if component.name in resolved.damaged or isinstance(one.item, Region):
            continue
        name, rows, problem = one.item.name, component.runnables(), None
        if isinstance(one.item, Data):
            if not any(name in row.writes for row in rows):
                problem = "nothing writes it, so it keeps its initial value"
        elif one.item.direction is Direction.OUT and not any(name in row.sends for row in rows):
            problem = "nothing sends on it"
        if problem is not None:
            message = f"{one.element} cannot be recorded: {problem}"
            notes = [(one.item.origin, f"`{name}` is declared here")]
            hint = "remove it from `record`"
            yield error("RV-0810", one.origin, message, notes=notes, hint=hint)


def records_have_a_trace(resolved: Resolved) -> Iterator[Diagnostic]:
    """The node of a recorded item has a trace; an error for each node that has none."""
    system = resolved.system
    nodes = {node.name: node for node in system.nodes}
    told: set[str] = set()
    for one in system.recorded:
        node = nodes.get(system.instance(one.instance).node)
        if node is not None and node.trace_depth == 0 and node.name not in told:
            told.add(node.name)
            message = f"{one.element} cannot be recorded: {node.name} keeps no trace"
            notes = [(node.origin, f"{node.name} is declared here")]
            hint = f"add `trace: 1024` to {node.name}, or remove it from `record`"
            yield error("RV-0810", one.origin, message, notes=notes, hint=hint)


def items_are_recorded_once(resolved: Resolved) -> Iterator[Diagnostic]:
    """No value is recorded twice."""
    first: dict[str, RecordedItem] = {}
    for one in resolved.system.recorded:
        for element in _recorded(one):
            other = first.setdefault(element, one)
            if other is not one:
                message = f"{element} is recorded twice"
                notes = [(other.origin, "the first is here")]
                hint = "remove one of them"
                yield error("RV-0803", one.origin, message, notes=notes, hint=hint)
                break


def _recorded(one: RecordedItem) -> list[str]:
    return [value.element for value in one.values] or [one.element]


RECORDING_RULES = (recorded_items_have_values, records_have_a_trace, items_are_recorded_once)
