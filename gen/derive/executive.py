# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Cyclic executives: the phases of a table whose releases shall all have about the same work.

The processor's period is the minor cycle, and the table repeats with the major cycle (Baker and
Shaw, The cyclic executive model and Ada, RTSS 1988). Rows that are hard to place come first: those
that run most often, then those with the longest WCET. Each gets the phase at which the releases
that execute it have the least work; of several the first. Then single rows change their phases as
long as that makes the longest release shorter, or all of them more even. To find the best table is
a hard problem, so a better one may exist. The same model always gets the same table.
"""

from __future__ import annotations

from dataclasses import replace

from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Processor, Slot

ROUNDS = 20
"""How often all rows are looked at for a better phase at most."""


def spread(processor: Processor) -> Processor:
    """The processor with phases for all rows to which the model gives none."""
    work = [0] * processor.cycle
    phases: dict[str, int] = {}
    for slot in sorted(processor.slots, key=_hardest_first):
        phases[slot.element] = slot.phase if slot.placed_at else _quietest(slot, work)
        _add(work, slot, phases[slot.element], 1)
    for _ in range(ROUNDS):
        before = _quality(work)
        for slot in processor.slots:
            if slot.placed_at is None:
                phases[slot.element] = _better(slot, phases[slot.element], work)
        if _quality(work) == before:
            break
    placed = (
        replace(slot, phase=phase, after=Ns(phase * processor.period))
        for slot in processor.slots
        for phase in (phases[slot.element],)
    )
    return replace(processor, slots=tuple(placed))


def _hardest_first(slot: Slot) -> tuple[bool, int, int]:
    return slot.placed_at is None, slot.divisor, -slot.timing.wcet


def _add(work: list[int], slot: Slot, phase: int, sign: int) -> None:
    for k in range(phase, len(work), slot.divisor):
        work[k] += sign * slot.timing.wcet


def _quietest(slot: Slot, work: list[int]) -> int:
    """The phase at which the longest of the releases that execute the row has the least work."""
    return min(range(slot.divisor), key=lambda phase: (max(work[phase :: slot.divisor]), phase))


def _quality(work: list[int]) -> tuple[int, int]:
    """The longest release, then how uneven all are."""
    return max(work), sum(time * time for time in work)


def _better(slot: Slot, now: int, work: list[int]) -> int:
    """The phase of a row with which the releases are best, with all other rows where they are."""
    _add(work, slot, now, -1)
    found = now, _moved(slot, now, work)
    for phase in range(slot.divisor):
        made = _moved(slot, phase, work)
        found = (phase, made) if made < found[1] else found
    _add(work, slot, found[0], 1)
    return found[0]


def _moved(slot: Slot, phase: int, work: list[int]) -> tuple[int, int]:
    tried = work.copy()
    _add(tried, slot, phase, 1)
    return _quality(tried)
