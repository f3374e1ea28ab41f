# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The observed responses of the activities of a run, each from when its release was due.

A trace has the begin of each activity, and reports of each processor: how many releases have
completed, and the response of the last one. Each report dates the completion of one release. So
between two reports it is known which activities must have begun. Only where the trace has just
these records, the release of each record is known; else some were lost, and nothing is sampled.

    exact      the last activity of a release that a report gives the response of
    at most    an activity before another one of its release has ended when that one begins. The
               difference may be the execution of this activity, and preemption behind its end

A processor that is not periodic has no known instants of release: only the first kind is there.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from ravenchart.described import Described
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Processor, Slot, System

from .observed import Observation, Releases
from .timing import Analysis

BINS = 20
"""Bars of a histogram."""

NO_RELEASES = Releases(0, 0, Ns(0))
"""The counts of a processor at its start."""

BEFORE_ALL = Ns(-1)
"""Earlier than any record."""


@dataclass(frozen=True, slots=True)
class Begin:
    """A record of the trace: an activity began then, in ns."""

    at: Ns
    row: str


@dataclass(frozen=True, slots=True)
class RowSample:
    """One observed response of an activity, in ns from when its release was due."""

    row: str
    response: Ns
    exact: bool
    """Whether it is the response; else the response was at most this long."""
    at: Ns
    """When the report was read by which it is known."""


def _number(processor: Processor, release: int) -> int:
    """The place of a release in the table: each one of a sporadic processor is the first."""
    return release if processor.released_by is None else 0


def rows_executed(processor: Processor, release: int) -> tuple[str, ...]:
    """The activities of a release, which is counted from 0, in the order of their execution."""
    number = _number(processor, release)
    return tuple(s.element for s in processor.slots if number % s.divisor == s.phase)


def executions_of(processor: Processor, slot: Slot, releases: int) -> int:
    """In how many of its first releases a processor executes a slot."""
    if processor.released_by is not None:
        return releases if slot.phase == 0 else 0
    return max(0, -((slot.phase - releases) // slot.divisor))


def due_time(processor: Processor, release: int) -> Ns:
    """When a release of a periodic processor is due, which is counted from 0."""
    return Ns(processor.offset + release * processor.period)


def completion(processor: Processor, counts: Releases) -> Ns:
    """When the last release that is counted has completed, of a periodic processor."""
    if not counts.releases:
        return BEFORE_ALL
    return Ns(due_time(processor, counts.releases - 1) + (counts.last_response or 0))


def samples_between(
    processor: Processor, before: Releases, after: Releases, begins: Sequence[Begin]
) -> Iterator[RowSample]:
    """The responses in the releases between two reports of a processor.

    ``begins`` are the records after the completion that ``before`` dates, up to that of ``after``.
    """
    if after.last_response is None or after.releases <= before.releases:
        return
    last = after.releases - 1
    at = after.now if after.now is not None else completion(processor, after)
    rows = rows_executed(processor, last)
    if rows:
        yield RowSample(rows[-1], after.last_response, True, at)
    if processor.released_by is not None or len(begins) != sum(
        executions_of(processor, s, after.releases) - executions_of(processor, s, before.releases)
        for s in processor.slots
    ):
        return
    expected = [
        (release, row)
        for release in range(before.releases, after.releases)
        for row in rows_executed(processor, release)
    ]
    if [one.row for one in begins] != [row for _, row in expected]:
        return
    executed = zip(expected, begins, strict=True)
    for ((release, row), _), ((of_next, _), following) in pairwise(executed):
        if release == of_next:
            yield RowSample(row, Ns(following.at - due_time(processor, release)), False, at)


def parts_of(seen: Observation) -> Iterable[Observation]:
    """The observations of single controllers, each in its own time."""
    return seen.parts.values() or (seen,)


def processors_of(system: System, seen: Observation) -> Iterator[Processor]:
    """The processors of the controller that is observed."""
    there = {element.name.lower() for element in seen.map.of_kind("processor")}
    yield from (one for one in system.processors if one.name.lower() in there)


def samples(processor: Processor, seen: Observation) -> Iterator[RowSample]:
    """All of one processor of a controller, by the time of their reports."""
    rows = {slot.element for slot in processor.slots}
    begins = [
        Begin(one.time, one.element.name)
        for one in seen.records
        if one.kind == "activity" and one.element.name in rows
    ]
    begins.sort(key=lambda one: one.at)
    reports = [one for name, one in seen.reports if name.lower() == processor.name.lower()]
    for before, after in pairwise((NO_RELEASES, *reports)):
        first, end = (
            bisect_right(begins, completion(processor, one), key=lambda one: one.at)
            for one in (before, after)
        )
        yield from samples_between(processor, before, after, begins[first:end])


@dataclass(slots=True)
class RowHistogram(Described):
    """The responses of an activity in bins, beside C and R; times in ns."""

    name: str
    """Its name."""
    processor: str
    """The processor that executes it."""
    wcet: int
    """C."""
    bound: int | None
    """R of the activity in its release; null where the analysis has none."""
    width: int
    """Of a bin: bin k has the responses above k widths, up to k + 1 widths."""
    executions: int = 0
    """In how many releases it was executed, of those that are counted."""
    exact: list[int] = field(default_factory=lambda: [0] * BINS)
    """How many exact responses each bin has."""
    at_most: list[int] = field(default_factory=lambda: [0] * BINS)
    """How many upper estimates each bin has."""
    longest: int | None = None
    """The longest exact response; null where there is none."""
    longest_at_most: int | None = None
    """The longest upper estimate; null where there is none."""

    def add(self, sample: RowSample) -> None:
        """Count a response; where it is beyond the last bin, two bins become one until it is not.

        So the bins reach from 0 to R, or to R times a power of two.
        """
        while self.bin_of(sample.response) >= BINS:
            self._widen()
        counts = self.exact if sample.exact else self.at_most
        counts[self.bin_of(sample.response)] += 1
        if sample.exact:
            self.longest = max(self.longest or 0, sample.response)
        else:
            self.longest_at_most = max(self.longest_at_most or 0, sample.response)

    def bin_of(self, response: int) -> int:
        """The bin of a response; BINS or more where it is beyond the last one."""
        return max(0, (response - 1) // self.width)

    def _widen(self) -> None:
        self.width *= 2
        for counts in (self.exact, self.at_most):
            counts[:] = [a + b for a, b in zip(counts[::2], counts[1::2], strict=True)]
            counts += [0] * (BINS - len(counts))


def empty_histograms(analysis: Analysis, processors: Iterable[Processor]) -> list[RowHistogram]:
    """Those of all activities of processors, without responses, in the order of the tables."""
    bounds: Mapping[tuple[str, str], int] = {
        (task.element, row.row.name): row.bound for task, row in analysis.rows()
    }
    found = []
    for processor in processors:
        for slot in processor.slots:
            bound = bounds.get((processor.name, slot.element))
            reach = bound or slot.timing.deadline
            width = max(1, -(-reach // BINS))
            found.append(RowHistogram(slot.element, processor.name, slot.timing.wcet, bound, width))
    return found


def row_histograms(analysis: Analysis, seen: Observation) -> list[RowHistogram]:
    """The responses of all activities of a run, in the order of the tables."""
    found: list[RowHistogram] = []
    for part in parts_of(seen):
        for processor in processors_of(analysis.system, part):
            mine = empty_histograms(analysis, [processor])
            counts = part.processors.get(processor.name, NO_RELEASES)
            by_name = {one.name: one for one in mine}
            for slot in processor.slots:
                by_name[slot.element].executions = executions_of(processor, slot, counts.releases)
            for sample in samples(processor, part):
                by_name[sample.row].add(sample)
            found += mine
    return found
