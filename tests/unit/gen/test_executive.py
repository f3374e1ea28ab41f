# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Cyclic executives and phases: the releases that have work, and the bounds that follow."""

from __future__ import annotations

import itertools
import math
import random

import pytest

from ravenchart.analysis.findings.claims import claims_of, uncertified
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.gen.model.system import Processor
from tests.support.pump import loaded

HEAD = """\
system: Cyclic
types:
  Level: {range: [0, 100]}
components:
  Work:
    data:
"""
TAIL = """\
nodes:
  board: {context_switch: 5 us, critical_section: 2 us}
instances:
  work_1: {component: Work, node: board}
shutdown: {raises: [], grace: 0 ms}
processors:
  cycling:
    stack: 16 KiB
"""
MS = 1_000_000
SWITCHES, BLOCKING = 10_000, 2_000


def _model(rows: list[tuple[int, int]], *keys: str) -> str:
    """Rows with periods in ms and WCETs in us, on one processor with these keys."""
    numbers = range(len(rows))
    data = "".join(f"      d{n}: {{type: Level, initial: 0}}\n" for n in numbers)
    work = "".join(
        f"      a{n}: {{period: {t} ms, wcet: {c} us, body: [{{set: d{n}, to: 1}}]}}\n"
        for n, (t, c) in enumerate(rows)
    )
    given = "".join(f"    {key}\n" for key in keys)
    table = ", ".join(f"work_1.a{n}" for n in numbers)
    return f"{HEAD}{data}    activities:\n{work}{TAIL}{given}    activities: [{table}]\n"


def _analysed(text: str) -> Analysis:
    found = loaded(text)
    assert found.system is not None, found.diagnostics
    return analyse(found.system)


def _loads(processor: Processor) -> list[int]:
    """The work of each release of a cycle."""
    return [sum(row.timing.wcet for row in processor.rows_of(k)) for k in range(processor.cycle)]


def _some(chance: random.Random) -> list[tuple[int, int]]:
    periods = chance.choices((4, 8, 12, 16, 24), k=chance.randint(2, 5))
    return [(period, chance.randint(20, 900)) for period in periods]


@pytest.mark.parametrize("seed", range(40))
def test_the_longest_release_is_near_the_shortest_possible(seed: int) -> None:
    rows = _some(random.Random(seed))
    (processor,) = _analysed(_model(rows, "schedule: table")).system.processors
    base = math.gcd(*(period for period, _ in rows)) * MS
    assert processor.period == base
    longest = max(_loads(processor))
    assert longest == processor.wcet
    cycle = processor.cycle
    best = min(
        max(
            sum(c for (t, c), p in zip(rows, phases, strict=True) if k % (t * MS // base) == p)
            for k in range(cycle)
        )
        for phases in itertools.product(*(range(t * MS // base) for t, _ in rows))
    )
    #  as of list scheduling: no more than the best, and one row besides
    assert best * 1000 <= longest <= (best + max(c for _, c in rows)) * 1000


@pytest.mark.parametrize("seed", range(40))
def test_a_bound_is_that_of_the_longest_release(seed: int) -> None:
    rows = _some(random.Random(100 + seed))
    analysis = _analysed(_model(rows, "schedule: table"))
    (processor,) = analysis.system.processors
    wanted = max(_loads(processor)) + SWITCHES + BLOCKING
    response = analysis.response("cycling")
    assert response.bound == wanted <= processor.deadline
    for row in response.rows:
        slots = [slot.element for slot in processor.slots]
        place = slots.index(row.row.name)
        done = max(
            sum(s.timing.wcet for s in processor.slots[: place + 1] if s in processor.rows_of(k))
            for k in range(processor.cycle)
            if processor.slots[place] in processor.rows_of(k)
        )
        assert row.bound == done + SWITCHES + BLOCKING


def test_a_certificate_claims_what_phases_allow() -> None:
    rows = [(5, 1000), *[(20, 3000)] * 4]
    analysis = _analysed(_model(rows, "schedule: table"))
    assert not list(uncertified(analysis))
    assert claims_of(analysis).items["cycling"].response == 4_000_000 + SWITCHES + BLOCKING
    without = _analysed(_model(rows))
    assert not without.schedulable
    assert without.response("cycling").bound == 13_000_000 + SWITCHES + BLOCKING


def test_a_phase_that_is_given_stays() -> None:
    keys = "schedule: table", "phases: {work_1.a1: 8 ms}"
    (processor,) = _analysed(_model([(4, 100), (12, 500), (12, 500)], *keys)).system.processors
    given, chosen = processor.slots[1:]
    assert (given.phase, given.after) == (2, 8 * MS)
    assert chosen.phase == 0


def test_a_minor_cycle_may_be_shorter_than_all_periods() -> None:
    keys = "schedule: table", "period: 5 ms"
    (processor,) = _analysed(_model([(10, 2000), (10, 2000)], *keys)).system.processors
    assert processor.period == 5 * MS
    assert [(slot.divisor, slot.phase) for slot in processor.slots] == [(2, 0), (2, 1)]


def test_phases_of_a_more_urgent_processor_are_not_counted_on_in_a_certificate() -> None:
    """Others count its rows each by itself: the claim holds, and is longer than the bound."""
    text = _model([(5, 500), (10, 1000), (10, 1000), (40, 200)], "phases: {work_1.a2: 5 ms}")
    text = text.replace(
        ", work_1.a3]", "]\n  below:\n    stack: 16 KiB\n    activities: [work_1.a3]"
    )
    analysis = _analysed(text)
    bound = analysis.response("below").bound
    assert bound is not None
    claimed = claims_of(analysis).items["below"].response
    assert claimed >= bound
    assert claimed == 200_000 + 500_000 + 2 * 1_000_000 + 2 * SWITCHES + BLOCKING


def test_phases_of_an_array_are_those_of_its_elements() -> None:
    text = _model([(5, 100), (10, 100)]).replace("work_1: {component", "work: {count: 2, component")
    text = text.replace("work_1.a0, work_1.a1", "work_*.a0, work_*.a1")
    text = text.replace("    stack: 16 KiB\n", "    stack: 16 KiB\n    phases: {work_*.a1: 5 ms}\n")
    (processor,) = _analysed(text).system.processors
    assert [(slot.element, slot.phase) for slot in processor.slots] == [
        ("work_1.a0", 0), ("work_2.a0", 0), ("work_1.a1", 1), ("work_2.a1", 1),
    ]  # fmt: skip
