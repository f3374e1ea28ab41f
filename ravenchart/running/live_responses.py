# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The responses of the activities of a running controller, from what it writes of its trace.

Memory is bounded: records are kept until the next report of their processor, and then only bins.
"""

from __future__ import annotations

import os
import re
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

from ravenchart import rounded
from ravenchart.analysis.system.observed import Observation, Releases, TraceMap, take_line
from ravenchart.analysis.system.row_responses import (
    NO_RELEASES,
    Begin,
    RowHistogram,
    RowSample,
    completion,
    empty_histograms,
    executions_of,
    processors_of,
    samples_between,
)
from ravenchart.analysis.system.timing import Analysis
from ravenchart.gen.language.terms import NO_TIME, Ns
from ravenchart.gen.model.system import Processor

from .held_files import trace_beside

MOST_READ = 262_144
"""Bytes of a trace that are read in one look. Where more is there, the end of it is read."""

MOST_BEGINS = 65_536
"""Records of a processor that are kept; with fewer than all nothing is sampled."""

HEAD = 64
"""So many bytes of a trace have its first line."""

NO_TRACE = (
    "Only the last activity of a release has samples, one of each snapshot at most: the trace of "
    "this controller is not at hand."
)


@dataclass(slots=True)
class LiveRows:
    """The responses of the activities of a controller, and the remark about their source."""

    rows: list[RowHistogram]
    """In the order of the tables."""
    note: str
    """Where they come from, and what is missing."""


@dataclass(slots=True)
class _Watched:
    """A processor, with what is known since the report that its samples begin with."""

    processor: Processor
    histograms: dict[str, RowHistogram]
    before: Releases | None
    """The last report whose releases are sampled; None before the first one."""
    first: int = 0
    """The releases that had completed before the samples begin."""
    after: Releases | None = None
    """The last report. Records of releases that it counts may still follow it."""
    begins: deque[Begin] = field(default_factory=lambda: deque(maxlen=MOST_BEGINS))

    def report(self, counts: Releases) -> None:
        """Take a report: all records of releases that the one before counts are there now."""
        if self.before is None:
            self.before, self.first = counts, counts.releases
            return
        self.settle()
        self.after = counts

    def settle(self) -> None:
        """Sample the releases up to the last report."""
        if self.before is None or self.after is None:
            return
        first, last = (completion(self.processor, one) for one in (self.before, self.after))
        known = sorted(self.begins, key=lambda one: one.at)
        self.begins.clear()
        self.begins.extend(one for one in known if one.at > last)
        there = [one for one in known if first < one.at <= last]
        self._add(samples_between(self.processor, self.before, self.after, there))
        self.before, self.after = self.after, None

    def _add(self, found: Iterable[RowSample]) -> None:
        for one in found:
            self.histograms[one.row].add(one)

    def shown(self) -> Iterator[RowHistogram]:
        """The histograms, with their numbers of executions."""
        releases = self.first if self.before is None else self.before.releases
        for slot in self.processor.slots:
            since, until = (
                executions_of(self.processor, slot, one) for one in (self.first, releases)
            )
            yield replace(self.histograms[slot.element], executions=until - since)


class LiveResponses:
    """The responses from the lines of a trace, as they come."""

    def __init__(self, analysis: Analysis, trace_map: TraceMap, *, whole: bool) -> None:
        """``whole``: the lines begin with the start of the controller."""
        self._seen = Observation(trace_map)
        self._watched = {
            one.name.lower(): _Watched(
                one,
                {row.name: row for row in empty_histograms(analysis, [one])},
                NO_RELEASES if whole else None,
            )
            for one in processors_of(analysis.system, self._seen)
        }
        self._owners = {
            slot.element: one
            for one in self._watched.values()
            if one.processor.released_by is None
            for slot in one.processor.slots
        }

    def take(self, line: str) -> None:
        """Take a line of the trace; ValueError says what is wrong with it."""
        take_line(line, self._seen)
        self.observe(self._seen)
        for kept in (self._seen.records, self._seen.values, self._seen.reports):
            kept.clear()

    def observe(self, new: Observation) -> None:
        """Take the records and reports of lines that have just been read."""
        for record in new.records:
            owner = self._owners.get(record.element.name)
            if record.kind == "activity" and owner is not None:
                owner.begins.append(Begin(record.time, record.element.name))
        for name, counts in new.reports:
            self.report(name, counts)
        if new.complete:
            for one in self._watched.values():
                one.settle()

    def report(self, name: str, counts: Releases) -> None:
        """Take the counts of a processor."""
        self._watched[name.lower()].report(counts)

    @property
    def until(self) -> Ns:
        """When the last report was read whose releases are sampled, in time of the controller."""
        reports = [one.before for one in self._watched.values() if one.before is not None]
        return max((one.now for one in reports if one.now is not None), default=NO_TIME)

    def shown(self) -> list[RowHistogram]:
        """All activities, in the order of the tables."""
        return [row for one in self._watched.values() for row in one.shown()]


class TraceTail:
    """A trace that a controller writes, read on from look to look."""

    def __init__(self, path: Path, start: Ns) -> None:
        """OSError where there is none; ValueError where it is not of the run of that start."""
        self._file = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
        self._rest = b""
        head = re.match(rb"E (\d{1,19})\s", os.pread(self._file, HEAD, 0))
        if head is None or int(head[1]) != start:
            self.close()
            raise ValueError(f"{path} is not the trace of the run that began at {start}")
        self._next = 0
        self.whole = os.fstat(self._file).st_size <= MOST_READ
        """Whether the lines begin with the start of the controller."""

    def close(self) -> None:
        """Read no longer."""
        os.close(self._file)

    def lines(self) -> list[str]:
        """The whole lines since the last look; of very many the last ones."""
        size = os.fstat(self._file).st_size
        skipped = size - self._next > MOST_READ
        if skipped:
            self._next, self._rest = size - MOST_READ, b""
        octets = self._rest + os.pread(self._file, size - self._next, self._next)
        self._next = size
        *whole, self._rest = octets.split(b"\n")
        return [line.decode("ascii", "replace") for line in whole[skipped:]]


class ProcessResponses:
    """The responses of a controller on this machine: from its trace, or else its snapshots."""

    def __init__(self, analysis: Analysis, trace_map: TraceMap, snapshots: Path) -> None:
        """``snapshots``: the file that the controller writes."""
        self._analysis, self._map = analysis, trace_map
        self._path = trace_beside(snapshots)
        self._start: Ns | None = None
        self._tail: TraceTail | None = None

    def close(self) -> None:
        """Read no longer."""
        if self._tail is not None:
            self._tail.close()
            self._tail = None

    def look(self, start: Ns, counts: Iterable[tuple[str, Releases]]) -> LiveRows:
        """The responses now, of the run of that start, whose snapshot has these counts."""
        if start != self._start:
            self.close()
            self._start = start
            self._responses = self._new(whole=False)
        if self._tail is None:
            with suppress(OSError, ValueError):  # not there, or not yet
                self._tail = TraceTail(self._path, start)
                self._responses = self._new(whole=self._tail.whole)
        if self._tail is None:
            for name, one in counts:
                self._responses.report(name, one)
            return LiveRows(self._responses.shown(), NO_TRACE)
        for line in self._tail.lines():
            with suppress(ValueError):
                self._responses.take(line)
        return LiveRows(self._responses.shown(), self._note())

    def _new(self, *, whole: bool) -> LiveResponses:
        return LiveResponses(self._analysis, self._map, whole=whole)

    def _note(self) -> str:
        until = rounded.instant(self._responses.until)
        return f"From the trace up to {until} s: the controller writes it in pieces of 16 KiB."
