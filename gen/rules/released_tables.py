# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Parts that the rules on processors released by a queue share."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.model.commands import Device, Gathered
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.system import Processor, Slot, System
from ravenchart.gen.origins import Origin

TABLE = "RV-0716"
"""The rule on the table of a processor that a queue releases."""

Problem = tuple[str, Origin, str, str]
"""The error, the location of its cause, a note on that, and the hint."""


def other_period(processor: Processor, slot: Slot) -> Iterator[Diagnostic]:
    """An error for a row that is not due in every release."""
    if slot.timing.period != processor.period:
        message = (
            f"the period of {slot.element} is {shown(slot.timing.period)}, but "
            f"{processor.name} runs it in each of its releases, which are "
            f"{shown(processor.period)} apart at least"
        )
        hint = f"give {slot.element} and {processor.name} the same `period`"
        yield error(TABLE, slot.origin, message, hint=hint)


def waiting_rows(
    system: System, processor: Processor, instance: Instance, cannot: str
) -> Iterator[Problem]:
    """Calls and messages of the rows of its table that need time."""
    own = {slot.name for slot in processor.slots if slot.owner == instance.name}
    rows = [row for row in instance.component.runnables() if row.name in own]
    used = {name for row in rows for name in (*row.sends, *row.reads)}
    told: set[str] = set()
    for binding in system.bindings:
        need = binding.need.command.name
        afar = binding.instance == instance.name and need in used - told
        if afar and not isinstance(binding.provider, Device | Gathered | None):
            told.add(need)
            message = f"{cannot}: its processor calls `{need}` of another component"
            yield message, binding.origin, "that is bound here", "bind it to a device"
    for sent in system.messages:
        source = sent.source
        if source is not None and source.instance == instance.name and source.name in used:
            message = f"{cannot}: its processor sends {source} as the message {sent.name}"
            words = f"{sent.name} is declared here"
            yield message, sent.origin, words, "let a periodic activity send the message"
