# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules for the tables of periodic processors: their periods, offsets and phases."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Processor, Slot, Work
from ravenchart.gen.resolve.system import Resolved

MOST_RELEASES = 1_000
"""Releases after which the table of a cyclic executive repeats at the latest."""


def periods_are_multiples(resolved: Resolved) -> Iterator[Diagnostic]:
    """A processor's period is the shortest in its table and divides the others."""
    for processor in resolved.system.processors:
        if processor.released_by is not None:
            continue
        slots = [slot for slot in processor.slots if slot.work is not Work.BUS_RECEIVE]
        if not slots:
            continue
        shortest = min(slots, key=lambda slot: slot.timing.period)
        base = shortest.timing.period
        if processor.cyclic:
            yield from _of_executive(processor, slots)
            continue
        if processor.period != base and "processors" in resolved.sound_sections:
            message = (
                f"the period of {processor.name} is given as {shown(processor.period)}, but the "
                f"shortest in its table is {shown(base)}"
            )
            notes = [(shortest.origin, f"{shortest.element} has it")]
            hint = f"write `period: {shown(base)}`, or leave `period` out"
            yield error("RV-0704", processor.origin, message, notes=notes, hint=hint)
        for slot in slots:
            if slot.timing.period % base:
                below = slot.timing.period // base * base
                message = (
                    f"the period of {slot.element}, {shown(slot.timing.period)}, is no multiple of "
                    f"{shown(base)}, the period of {processor.name}"
                )
                notes = [(shortest.origin, f"{shortest.element} sets that period")]
                hint = (
                    f"{shown(below)} or {shown(below + base)} would fit; or move it to another "
                    "processor"
                )
                yield error("RV-0704", slot.origin, message, notes=notes, hint=hint)


def _of_executive(processor: Processor, slots: Sequence[Slot]) -> Iterator[Diagnostic]:
    """The minor cycle divides all periods, and the major cycle has not too many of them."""
    whole = Ns(math.gcd(*(slot.timing.period for slot in slots)))
    for slot in slots:
        if slot.timing.period % processor.period:
            message = (
                f"the period of {slot.element}, {shown(slot.timing.period)}, is no multiple of "
                f"{shown(processor.period)}, the minor cycle of {processor.name}"
            )
            hint = f"leave `period` out: {shown(whole)} divides all periods"
            yield error("RV-0704", slot.origin, message, hint=hint)
            return
    major = math.lcm(*(slot.timing.period for slot in slots))
    if major // processor.period > MOST_RELEASES:
        message = (
            f"the table of {processor.name} repeats after {major // processor.period} releases; "
            f"the limit is {MOST_RELEASES}"
        )
        hint = "choose periods with a shorter common multiple"
        if major // whole <= MOST_RELEASES:
            hint = f"choose a longer `period`: {shown(whole)} divides all periods"
        yield error("RV-0704", processor.origin, message, hint=hint)


def offsets_are_shorter_than_periods(resolved: Resolved) -> Iterator[Diagnostic]:
    """The first release comes within the first period, and so does the first execution of a row."""
    for processor in resolved.system.processors:
        if processor.offset >= processor.period:
            message = (
                f"the offset of {processor.name}, {shown(processor.offset)}, is not shorter than "
                f"its period, {shown(processor.period)}"
            )
            yield error("RV-0708", processor.origin, message)
        for slot in processor.slots:
            yield from _unfit_phase(processor, slot)


def _unfit_phase(processor: Processor, slot: Slot) -> Iterator[Diagnostic]:
    """The first execution of a row is in a release of its first period."""
    base, period, phase = processor.period, slot.timing.period, slot.after
    if slot.placed_at is None or period % base:
        return
    if phase >= period:
        message = f"the phase of {slot.element}, {shown(phase)}, is not below {shown(period)}, "
        message += "its period"
    elif phase % base:
        message = f"the phase of {slot.element}, {shown(phase)}, is no multiple of {shown(base)}, "
        message += f"the period of {processor.name}"
    else:
        return
    below = min(phase // base * base, period - base)
    hint = f"{shown(below)} would fit" if below else "remove it: the row runs in every release"
    hint = hint if below or period == base else f"{shown(base)} would fit, or none"
    yield error("RV-0708", slot.placed_at, message, hint=hint)
