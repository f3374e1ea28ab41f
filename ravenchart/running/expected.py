# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The losses, misses and overruns of a run, compared with the expectations of its scenario.

The scenario must expect each count, with a reason, or the run fails. Only delays that the host
demonstrably caused are excused.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ravenchart import rounded
from ravenchart.analysis.present.report import Comparison, Execution
from ravenchart.analysis.system.journeys import Journey
from ravenchart.analysis.system.observed import TRACE, VALUES, Observation
from ravenchart.gen.model.system import System
from ravenchart.hw_can.bench.forms import EXPECTED, Expected
from ravenchart.hw_can.bench.scenario import Scenario

from .process import Ended

Key = tuple[str, str]
"""Key of a scenario's `expect`, and the name behind it."""

DEADLINE_MISS, OVERRUN = "DEADLINE_MISS", "OVERRUN"
"""Faults that are counted for each processor, and found in each row, too."""


def said(kind: str, name: str, count: int) -> str:
    """A count in words."""
    if kind == "missed":
        return f"{name} missed {count} deadline{'' if count == 1 else 's'}"
    if kind == "overran":
        return f"{name} {'ran' if count else 'never ran'} for longer than its WCET"
    return f"{kind}: {name}, {'once' if count == 1 else f'{count} times'}"


def longest_withheld(compared: Sequence[Comparison]) -> int:
    """The longest time for which the host withheld the core of a node, in ns."""
    return max((row.withheld for row in compared), default=0)


def excused(
    compared: Sequence[Comparison], executed: Sequence[Execution], ended: Ended
) -> tuple[frozenset[str], frozenset[str]]:
    """Processors and rows that were late or long by no more than the host withheld the core."""
    withheld = longest_withheld(compared)
    late = frozenset(row.task for row in compared if row.explained)
    long = frozenset(
        row.row
        for row in executed
        if row.exceeded and (not ended.real_time or row.observed - row.wcet <= withheld)
    )
    return late, long


def counted(
    seen: Observation,
    compared: Sequence[Comparison],
    executed: Sequence[Execution],
    ended: Ended,
) -> dict[Key, int]:
    """Every fault of a run, with its count; without what the host is excused for."""
    late, long = excused(compared, executed, ended)
    found: dict[Key, int] = {}
    for what, n in seen.losses.items():
        if what.lower().rpartition(".")[2] not in (TRACE, VALUES):
            found["lost", what] = n
    for what, n in seen.faults.items():
        if what.upper() == OVERRUN and (long or not ended.real_time):
            continue
        if what.upper() != DEADLINE_MISS:
            found["fault", what] = n
    for name, processor in seen.processors.items():
        if name not in late:
            found["missed", name] = processor.misses
    for row in executed:
        if row.exceeded and row.row not in long:
            found["overran", row.row] = 1
    return {key: n for key, n in found.items() if n}


def judged(plan: Scenario | None, system: System | None, found: dict[Key, int]) -> Iterator[str]:
    """The reasons why a run fails by its counts.

    Without a scenario the bus may have no other node: then losses there, and the faults that
    follow, are no failure.
    """
    if plan is None:
        alone = system is not None and bool(system.buses)
        of_time = {key: n for key, n in found.items() if key[0] in ("missed", "overran")}
        for (kind, name), n in (of_time if alone else found).items():
            yield said(kind, name, n)
    else:
        yield from _differences(plan.expected, found)


def _differences(expected: Sequence[Expected], found: dict[Key, int]) -> Iterator[str]:
    """In words, each count that is not expected, and each expectation that did not hold."""
    told = {(_kind(one), one.name.lower()): one for one in expected}
    for (kind, name), n in found.items():
        words = said(kind, name, n)
        match = told.pop((kind, name.lower()), None)
        if match is None:
            yield f"{words}; the scenario does not expect it"
        elif not match.allows(n):
            yield f"{words}; the scenario expects {match.limit}"
    for (kind, _), one in told.items():
        if not one.allows(0):
            yield f"{said(kind, one.name, 0)}; the scenario expects {one.limit}"


def told(plan: Scenario | None, found: dict[Key, int]) -> Iterator[str]:
    """The losses and each fault, with the cause that the scenario gives."""
    causes = {
        (_kind(one), one.name.lower()): one.because for one in (plan.expected if plan else ())
    }
    for (kind, name), n in found.items():
        cause = causes.get((kind, name.lower()))
        if kind in ("lost", "fault") or cause is not None:
            yield said(kind, name, n) + (f": {cause}" if cause else "")


def _kind(one: Expected) -> str:
    return next(key for key, form in EXPECTED.items() if isinstance(one, form))


def not_judged(
    compared: Sequence[Comparison],
    executed: Sequence[Execution],
    took: Sequence[Journey],
    ended: Ended,
) -> str | None:
    """Why the timing of the run says nothing; None where it was judged."""
    if not ended.real_time:
        return "the controller had no real-time priorities"
    withheld = longest_withheld(compared)
    late = any(row.is_explained(withheld) for row in took)
    if not late and not any(excused(compared, executed, ended)):
        return None
    return f"the host withheld the core for up to {rounded.up(withheld)}"
