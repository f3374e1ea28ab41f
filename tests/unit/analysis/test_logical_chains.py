# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Chains over logical execution times: their bounds against every release of a hyperperiod."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

import pytest

from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.gen.model.logical import logical_links
from tests.support.pump import loaded

MODEL = """\
system: Instants
types:
  Level: {{range: [0, 100]}}
components:
  Source:
    ports:
      level: {{out: Level}}
    activities:
      give: {{period: {sent} ms, wcet: 20 us, {sends}}}
  Sink:
    ports:
      level: {{in: Level}}
    port_region: {{period: {taken} ms, wcet: 20 us}}
    data:
      kept: {{type: Level, initial: 0}}
    activities:
      keep: {{period: {taken} ms, wcet: 20 us, body: [{{set: kept, to: level}}]}}
nodes:
  board: {{context_switch: 5 us, critical_section: 2 us}}
instances:
  source_1: {{component: Source, node: board}}
  sink_1: {{component: Sink, node: board}}
connections:
  - {{from: source_1.level, to: sink_1.level}}
processors:
  giving: {{offset: {first} ms, {lasting} stack: 16 KiB, activities: [source_1.give]}}
  keeping: {{offset: {then} ms, stack: 16 KiB, activities: [sink_1.ports, sink_1.keep]}}
chains:
  whole: {{path: [source_1.give, sink_1.keep], reaction: 1 s, age: 1 s}}
shutdown: {{raises: [], grace: 0 ms}}
"""

ALWAYS, SOMETIMES = "body: [{send: level, with: 1}]", "may_send: [level], body: user"
MS = 1_000_000


@dataclass(frozen=True)
class Times:
    """The times of a case, in ms."""

    sent: int
    taken: int
    first: int
    then: int
    lasting: int

    def analysed(self, *, logical: bool = True, sends: str = ALWAYS) -> Analysis:
        """The analysis of its model."""
        lasting = f"logical_execution_time: {self.lasting} ms," if logical else ""
        text = MODEL.format(**{**vars(self), "lasting": lasting}, sends=sends)
        found = loaded(text)
        assert found.system is not None, found.diagnostics
        return analyse(found.system)

    def longest(self) -> tuple[int, int]:
        """The longest time from a release that sends to the one that takes, and back, in ms."""
        cycle = math.lcm(self.sent, self.taken)
        sends = range(self.first, 8 * cycle, self.sent)
        takes = range(self.then, 8 * cycle, self.taken)
        there = max(
            next(r for r in takes if r >= w + self.lasting) - w for w in sends if w < 3 * cycle
        )
        back = max(
            r - max(w for w in sends if w + self.lasting <= r)
            for r in takes
            if 4 * cycle <= r < 6 * cycle
        )
        return there, back


def _some(chance: random.Random) -> Times:
    sent, taken = (chance.choice((2, 3, 4, 5, 6, 8, 10, 12)) for _ in range(2))
    return Times(
        sent, taken, chance.randrange(sent), chance.randrange(taken), chance.randint(1, sent)
    )


@pytest.mark.parametrize("seed", range(60))
def test_the_bounds_are_the_longest_times(seed: int) -> None:
    case = _some(random.Random(seed))
    analysis = case.analysed()
    assert analysis.schedulable
    (_, found), there_and_back = analysis.limited[0], case.longest()
    #  before: an input that was just missed; behind: the response of the last row
    last = found.hops[-1].response
    assert last is not None
    before = [case.sent * MS, 0]
    for bound, longest, more in zip(
        (found.reaction, found.age), there_and_back, before, strict=True
    ):
        response = sum(hop.response or 0 for hop in found.hops[1:])
        assert bound == more + longest * MS + response, (case, there_and_back)


def test_without_them_the_waits_are_whole_periods() -> None:
    case = Times(sent=10, taken=10, first=0, then=0, lasting=10)
    (_, logical), (_, plain) = (case.analysed(logical=b).limited[0] for b in (True, False))
    assert logical.hops[1].wait == 0 and plain.hops[1].wait == 10 * MS
    assert logical.hops[0].response == 10 * MS


def test_a_row_that_may_send_nothing_has_no_age() -> None:
    case = Times(sent=10, taken=10, first=0, then=0, lasting=10)
    (_, found) = case.analysed(sends=SOMETIMES).limited[0]
    assert found.age is None and found.hops[1].wait == 0


@pytest.mark.parametrize("seed", range(60))
def test_the_mailbox_keeps_what_a_receiver_may_need(seed: int) -> None:
    """In the last instant of its deadline: the value that was visible at its release is kept."""
    case = _some(random.Random(1000 + seed))
    (link,) = logical_links(case.analysed().system)
    cycle = math.lcm(case.sent, case.taken)
    most = 0
    for release in range(case.then + 2 * cycle, case.then + 4 * cycle, case.taken):
        sent = [w for w in range(case.first, 8 * cycle, case.sent) if w < release + case.taken]
        needed = max(w for w in sent if w + case.lasting <= release)
        most = max(most, sum(w >= needed for w in sent))
    assert most <= link.depth <= most + 1


ROWS = """\
      give: {period: 10 ms, wcet: 20 us, body: [{send: level, with: 1}]}
      more: {period: 10 ms, wcet: 20 us, body: [{send: level, with: 2}]}
"""


@pytest.mark.parametrize(("phase", "taken", "depth"), [("5 ms", 200, 43), ("0 ms", 200, 43)])
def test_each_row_that_sends_has_its_values_in_the_mailbox(
    phase: str, taken: int, depth: int
) -> None:
    """L + D = 205 ms: with releases 5 ms apart up to 41 values come meanwhile, by two rows 42."""
    case = Times(sent=10, taken=taken, first=0, then=0, lasting=5)
    text = MODEL.format(**{**vars(case), "lasting": "logical_execution_time: 5 ms,"}, sends=ALWAYS)
    row = "      give: {period: 10 ms, wcet: 20 us, body: [{send: level, with: 1}]}\n"
    base = "      beat: {period: 5 ms, wcet: 20 us, body: [{set: beats, to: 1}]}\n"
    data = "    data:\n      beats: {type: Level, initial: 0}\n    activities:\n"
    assert row in text
    text = text.replace("    activities:\n" + row, data + base + ROWS, 1)
    table = f"phases: {{source_1.more: {phase}}}, "
    text = text.replace("[source_1.give]", "[source_1.beat, source_1.give, source_1.more]")
    text = text.replace("giving: {", "giving: {" + table)
    found = loaded(text)
    assert found.system is not None, found.diagnostics
    (link,) = logical_links(found.system)
    assert link.depth == min(depth, 1 + 41)
