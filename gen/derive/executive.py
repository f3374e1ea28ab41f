# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Cyclic executives: the phases of a table whose releases shall all have about the same work.

The processor's period is the minor cycle, and the table repeats with the major cycle (Baker and
Shaw, The cyclic executive model and Ada, RTSS 1988). Rows that are hard to place come first: those
that run most often, then those with the longest WCET. Each gets the phase with which the longest
release is shortest; of several the first. The same model always gets the same table.
"""

from __future__ import annotations

from dataclasses import replace

from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Processor, Slot


def spread(processor: Processor) -> Processor:
    """The processor with phases for all rows to which the model gives none."""
    work = [0] * processor.cycle
    placed: dict[str, Slot] = {}
    for slot in sorted(processor.slots, key=_hardest_first):
        phase = slot.phase if slot.is_placed else _quietest(slot, work)
        for k in range(phase, len(work), slot.divisor):
            work[k] += slot.timing.wcet
        after = Ns(phase * processor.period)
        placed[slot.element] = replace(slot, phase=phase, after=after)
    return replace(processor, slots=tuple(placed[slot.element] for slot in processor.slots))


def _hardest_first(slot: Slot) -> tuple[bool, int, int]:
    return not slot.is_placed, slot.divisor, -slot.timing.wcet


def _quietest(slot: Slot, work: list[int]) -> int:
    """The phase at which the longest of the releases that execute the row has the least work."""
    return min(range(slot.divisor), key=lambda phase: (max(work[phase :: slot.divisor]), phase))
