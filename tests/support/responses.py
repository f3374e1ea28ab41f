# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A processor with divisors, and traces of it with known responses."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache

from ravenchart.analysis.system.observed import TraceMap, read_map
from ravenchart.analysis.system.row_responses import rows_executed
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.gen.emit.tables.trace_map import trace_json
from ravenchart.gen.model.system import Processor
from tests.support.pump import loaded

US = 1_000
MS = 1_000_000

MODEL = """\
system: Desk
types:
  Count: {range: [0, 1000]}
components:
  Worker:
    events: [Late]
    data: {rounds: {type: Count, initial: 0}, hours: {type: Count, initial: 0}}
    regions:
      Control:
        period: 10 ms
        wcet: 1 ms
        queue: 4
        initial: Fine
        states: {Fine: {}, Tardy: {}}
        transitions:
          late: {from: Fine, to: Tardy, on: Late}
    activities:
      toil:
        period: 10 ms
        wcet: 1 ms
        body: [{set: rounds, to: "min(rounds + 1, 1000)"}]
      rest:
        period: 20 ms
        wcet: 2 ms
        body: [{set: hours, to: "min(hours + 1, 1000)"}]
nodes:
  board: {context_switch: 10 us, critical_section: 5 us, trace: 64}
instances:
  own: {component: Worker, node: board}
processors:
  work: {stack: 16 KiB, on_deadline_miss: [own.Late], activities: [own.Control, own.toil, own.rest]}
shutdown: {raises: [own.Late], grace: 10 ms}
"""


@cache
def desk() -> Analysis:
    """One processor of 10 ms: two activities in each release, a third in every other one."""
    found = loaded(MODEL)
    assert found.system is not None, found.diagnostics
    return analyse(found.system)


@cache
def desk_map() -> TraceMap:
    """Its numbered elements."""
    return read_map(trace_json(desk().system))


def work() -> Processor:
    """Its processor."""
    (found,) = desk().system.processors
    return found


def lines(*told: str, names: TraceMap | None = None) -> list[str]:
    """Lines of a trace, with names and ms: ``B time row``, ``P now processor releases last``."""
    found = []
    known = names or desk_map()
    for one in told:
        kind, time, name, *numbers = one.split()
        at = round(float(time) * MS)
        if kind == "B":
            found.append(f"T {at} Activity {known.named(name, 'row').number} 0")
        else:
            releases, last = numbers
            response = round(float(last) * MS)
            number = known.named(name, "processor").number
            found += [f"N {at}", f"P {number} {releases} 0 {response} {response}"]
    return found


@dataclass(frozen=True, slots=True)
class TrueResponse:
    """The response of an activity in a release, as it really was."""

    row: str
    release: int
    response: int
    ends_by: int | None
    """When the next activity of the release began; None for the last one. Both in ns from due."""


def random_run(
    seed: int, losses: int, releases: int = 300
) -> tuple[list[str], Sequence[TrueResponse]]:
    """The lines of a run of the desk without so many of its records, and its true responses.

    Rows are preempted, releases are late at times, and records may come behind a report that
    counts their release.
    """
    chance = random.Random(seed)
    processor, known = work(), desk_map()
    true: list[TrueResponse] = []
    records: list[tuple[int, str]] = []
    reports: list[tuple[int, int, int]] = []
    now = 0
    for release in range(releases):
        due = processor.offset + release * processor.period
        now = max(now, due) + chance.choice((5, 40, 3_000)) * US
        rows = rows_executed(processor, release)
        for row in rows:
            number = known.named(row, "row").number
            records.append((now, f"T {now} Activity {number} 0"))
            now += chance.choice((300, 900, 4_000)) * US
            response = now - due
            now += chance.choice((1, 2, 2_000)) * US  # of others, before the next one
            ends_by = None if row == rows[-1] else now - due
            true.append(TrueResponse(row, release, response, ends_by))
        if chance.random() < 0.1:
            reports.append((now, release + 1, due + response))
    gone = set(chance.sample(range(len(records)), losses))
    kept = [one for place, one in enumerate(records) if place not in gone]
    return list(_interleaved(chance, kept, reports)), true


def _interleaved(
    chance: random.Random, kept: list[tuple[int, str]], reports: list[tuple[int, int, int]]
) -> Iterator[str]:
    processor = work()
    number = desk_map().named("work", "processor").number
    records = iter(kept)
    waiting = next(records, None)
    for now, releases, done in reports:
        behind = chance.choice((0, 4 * MS))  # not drained yet when the counts were read
        while waiting is not None and waiting[0] <= now - behind:
            yield waiting[1]
            waiting = next(records, None)
        last = done - processor.offset - (releases - 1) * processor.period
        yield f"N {now}"
        yield f"P {number} {releases} 0 {last} {last}"
    while waiting is not None:
        yield waiting[1]
        waiting = next(records, None)
