# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Parts that the rules on processors released by a queue share."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.model.system import Processor, Slot
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
