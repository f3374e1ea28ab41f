# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules for interrupts, and for the processors that they release."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.nodes import PROBE, STREAM, SUPERVISOR, Interrupt, InterruptLine, Node
from ravenchart.gen.model.system import Processor, Slot, System, Work
from ravenchart.gen.resolve.system import Resolved

from .released_tables import TABLE, other_period, waiting_rows

UNFIT = "RV-0718"
"""The rule on what an interrupt releases."""


def interrupts_release_processors(resolved: Resolved) -> Iterator[Diagnostic]:
    """Each interrupt releases one processor of the first core, and each has a source of its own."""
    system = resolved.system
    for node in system.nodes:
        for place, interrupt in enumerate(node.interrupts):
            yield from _alone(node, interrupt, node.interrupts[:place])
            if "processors" in resolved.sound_sections:
                yield from _releases(system, InterruptLine(node.name, interrupt.name), interrupt)


def _alone(node: Node, interrupt: Interrupt, before: tuple[Interrupt, ...]) -> Iterator[Diagnostic]:
    """Its name and its source are those of nothing else on the node."""
    if interrupt.name.lower() in (PROBE, STREAM, SUPERVISOR):
        message = f"the interrupt {interrupt.name} is named like a task of {node.name}"
        yield error(UNFIT, interrupt.origin, message, hint="rename it")
    for other in before:
        for key in ("signal", "number"):
            own = getattr(interrupt, key)
            if own is not None and own == getattr(other, key):
                message = f"{interrupt.name} and {other.name} have the same `{key}`, {own}"
                notes = [(other.origin, f"{other.name} is declared here")]
                hint = "give each interrupt a source of its own"
                yield error(UNFIT, interrupt.origin, message, notes=notes, hint=hint)


def _releases(system: System, line: InterruptLine, interrupt: Interrupt) -> Iterator[Diagnostic]:
    """One processor, which may be released as often as the interrupt can be taken."""
    released = [one for one in system.processors if one.released_by == line]
    if not released:
        hint = f"add a processor with `released_by: {line}`, or remove the interrupt"
        yield error(UNFIT, interrupt.origin, f"{line} releases no processor", hint=hint)
    for other in released[1:]:
        message = f"{line} releases {released[0].name} and {other.name}"
        notes = [(released[0].origin, f"{released[0].name} is declared here")]
        hint = "put the rows of both into one processor"
        yield error(UNFIT, other.released_at or other.origin, message, notes=notes, hint=hint)
    for one in released[:1]:
        at = one.released_at or one.origin
        if one.core != 1:
            message = f"{line} releases {one.name} on core {one.core}: interrupts come to core 1"
            yield error(UNFIT, at, message, hint="leave `core` out")
        if interrupt.wcet > one.period:
            message = f"taking {line} may need {shown(interrupt.wcet)}, longer than the least "
            message += f"separation of {one.name}, {shown(one.period)}"
            yield error("RV-0703", at, message)


def tables_of_interrupts(resolved: Resolved) -> Iterator[Diagnostic]:
    """Activities that need no time of their own, in each release."""
    system = resolved.system
    if "processors" not in resolved.sound_sections:
        return
    for processor in system.processors:
        line = processor.released_by_interrupt
        if line is None:
            continue
        for slot in processor.slots:
            if slot.of_bus or not _fits(system.instance(slot.owner), slot):
                message = f"{processor.name} is released by {line}, but holds {slot.element}"
                hint = "move it to a periodic processor; an activity may raise an event for a chart"
                yield error(TABLE, slot.origin, message, hint=hint)
            else:
                yield from other_period(processor, slot)
        if {"instances", "messages"} <= resolved.sound_sections:
            yield from _of_rows(system, processor)


def _fits(instance: Instance, slot: Slot) -> bool:
    """An activity without `while` that serves no calls."""
    component = instance.component
    activities = {one.name: one for one in component.activities}
    if slot.work is not Work.ACTIVITY or component.served_by(slot.name) is not None:
        return False
    return activities[slot.name].while_in is None


def _of_rows(system: System, processor: Processor) -> Iterator[Diagnostic]:
    """Calls and messages of the rows that need time."""
    at = processor.released_at or processor.origin
    for owner in dict.fromkeys(slot.owner for slot in processor.slots if not slot.of_bus):
        instance = system.instance(owner)
        cannot = f"{processor.released_by} cannot release {processor.name}"
        for message, declared, words, hint in waiting_rows(system, processor, instance, cannot):
            yield error(UNFIT, at, message, notes=[(declared, words)], hint=hint)


INTERRUPT_RULES: tuple[Callable[[Resolved], Iterator[Diagnostic]], ...] = (
    interrupts_release_processors,
    tables_of_interrupts,
)
