# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A bus that is too slow: one error at its bit rate, in place of all that follow from it."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace

from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.model.buses import Bus

from .causes import RootFinding

TOO_SLOW = "RV-0910"
"""Several limits are exceeded, and a higher bit rate of one bus meets all of them."""

STANDARD = (10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000, 800_000, 1_000_000)
"""The bit rates of CiA 301 and 100 kbit/s, in bit/s."""

SEVERAL = 3
"""With fewer errors each of them is reported: then the bit rate need not be the cause."""

SHOWN = 3
"""Errors that the notes repeat."""


def blamed_on_a_bus(
    analysis: Analysis,
    found: Sequence[RootFinding],
    judged: Callable[[Analysis], Sequence[Diagnostic]],
) -> tuple[Diagnostic, ...]:
    """The findings; one error in place of all that a higher bit rate of one bus removes.

    ``judged`` gives the findings of a changed system. The error of an overloaded bus names the
    rate that meets every limit, and then is the only error. A bus whose identifiers the analysis
    chooses is left out: another rate may give them another order.
    """

    def left(bus: Bus, rate: int) -> set[object]:
        """The limits that are exceeded at another rate."""
        other = judged(_with_rate(analysis, bus, rate))
        return {_subject(one) for one in other if one.is_error}

    if analysis.overloaded:
        return _of_overloads(analysis.overloaded, found, left)
    shown = tuple(one.shown for one in found)
    late = [one for one in shown if one.is_error]
    for bus in analysis.system.buses:
        rates = _higher(bus)
        if len(late) < SEVERAL or not rates:
            continue
        always = left(bus, rates[-1])
        gone = [one for one in late if _subject(one) not in always]
        if len(gone) >= SEVERAL:
            rate = next(one for one in rates if left(bus, one) <= always)
            return (_too_slow(bus, rate, gone), *(one for one in shown if one not in gone))
    return shown


def _subject(one: Diagnostic) -> object:
    """The limit that is exceeded: the same at each bit rate, whatever the numbers."""
    return one.code, one.origin, re.split(r"\d", one.message)[0]


def _of_overloads(
    overloaded: Sequence[Bus], found: Sequence[RootFinding], left: Callable[[Bus, int], set[object]]
) -> tuple[Diagnostic, ...]:
    """The findings beside overloaded buses.

    Where a rate of one bus meets every limit, its error names the rate and counts all others.
    """
    for bus in overloaded:
        rate = next((rate for rate in _higher(bus) if not left(bus, rate)), None)
        if rate is None:
            continue
        own = next(
            one for one in found if one.cause == bus.name and one.diagnostic.origin == bus.origin
        )
        others = [one for one in found if one.diagnostic.is_error and one is not own]
        count = own.dependents + sum(1 + one.dependents for one in others)
        text = f"`bit_rate: {_spoken(rate)}` is the lowest standard rate that meets all limits"
        named = replace(own.diagnostic, hint=f"{own.diagnostic.hint}: {text}")
        root = replace(own, diagnostic=named, dependents=count)
        return (root.shown, *(one.shown for one in found if not one.diagnostic.is_error))
    return tuple(one.shown for one in found)


def _higher(bus: Bus) -> tuple[int, ...]:
    """The standard rates above that of the bus, and not above that of the data of its FD frames.

    None where the analysis chooses the identifiers.
    """
    if bus.audsley:
        return ()
    most = STANDARD[-1] if bus.data_rate is None else min(STANDARD[-1], bus.data_rate)
    return tuple(rate for rate in STANDARD if bus.bit_rate < rate <= most)


def _with_rate(analysis: Analysis, bus: Bus, rate: int) -> Analysis:
    """The same system with another bit rate of that bus."""
    system = analysis.system
    buses = tuple(replace(one, bit_rate=rate) if one == bus else one for one in system.buses)
    return analyse(replace(system, buses=buses))


def _too_slow(bus: Bus, rate: int, late: Sequence[Diagnostic]) -> Diagnostic:
    """The error of a bus at which so much is late."""
    notes = [(one.origin, one.message) for one in late[:SHOWN]]
    if more := len(late) - SHOWN:
        notes.append((bus.origin, f"`ravenchart analyse` shows the other {more}"))
    return error(
        TOO_SLOW,
        bus.origin,
        f"{bus.name} is too slow: at {_spoken(bus.bit_rate)} {len(late)} limits are exceeded",
        notes=notes,
        hint=f"`bit_rate: {_spoken(rate)}` is the lowest standard rate that meets all of them",
    )


def _spoken(rate: int) -> str:
    """A bit rate as a model has it."""
    return f"{rate / 1000:g} kbit/s"
