# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The growth of one execution time, all others unchanged, until a deadline or limit is missed."""

from __future__ import annotations

from collections.abc import Collection
from fractions import Fraction

from ravenchart.analysis.core.changes import Part, shrunk
from ravenchart.analysis.core.sensitivity import greatest
from ravenchart.analysis.system.timing import Analysis
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Slot

from .advice import keeps_all

STEP = 1_000
"""Execution times grow by whole microseconds."""


def largest_wcet(analysis: Analysis, rows: Collection[str]) -> Ns | None:
    """The longest WCET, in ns, that these rows may have together; None where it is too long now.

    ``rows`` (``owner.name``) have one WCET: those of one activity, in all instances of its
    component. A WCET is never longer than the deadline. Its growth is rounded down to whole us.
    KeyError where no table has such a row.
    """
    slots = _slots(analysis, rows)
    wcet, longest = slots[0][1].timing.wcet, min(slot.timing.deadline for _, slot in slots)
    parts: list[Part] = [(task, slot.element) for task, slot in slots]
    holds = keeps_all(analysis)

    def may_grow(steps: int) -> bool:
        grown = wcet + steps * STEP
        return holds(shrunk(analysis.network, parts, Fraction(grown, wcet)))

    found = greatest(may_grow, 0, max(0, (longest - wcet) // STEP))
    return None if found is None else Ns(wcet + found * STEP)


def _slots(analysis: Analysis, rows: Collection[str]) -> list[tuple[str, Slot]]:
    """The rows with their tasks."""
    tasks = analysis.system.tasks
    found = [(task.element, slot) for task in tasks for slot in task.slots if slot.element in rows]
    if not found:
        raise KeyError(", ".join(rows))
    return found
