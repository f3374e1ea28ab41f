# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A recorded run shown again: the snapshot that its controllers would have given at any instant.

An instant is a time in ns from the first start of all controllers. The snapshot there follows
from the trace up to the instant, and from nothing that was shown before. So the way to an instant
does not matter.
"""

from __future__ import annotations

import time
from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from operator import attrgetter

from ravenchart import rounded
from ravenchart.analysis.system.observed import (
    TRACE,
    VALUE,
    VALUES,
    Observation,
    TraceRecord,
    read_trace,
)
from ravenchart.analysis.system.row_responses import RowHistogram
from ravenchart.analysis.system.timing import Analysis
from ravenchart.gen.language.terms import NO_TIME, Ns

from .monitored import LISTED, NO_COUNTS, NodeMonitor, WatchedNode, event_of
from .row_histories import histories
from .snapshots import KINDS, RECENT, Snapshot, Tally
from .traces.files import NodeTrace
from .traces.values import Point, Quantity, extremes

SIMULATED = "times and faults, messages and queues: a simulation has none"
"""The facts that no simulation shows."""

MOST_POINTS = 480
"""Of more points of a value some are left out."""

MOST_KEPT = 100_000
"""So many times are kept of which the extremes are known."""

STEPS: Mapping[str, tuple[str, ...]] = {"event": LISTED, "value": (VALUE,), "record": KINDS}
"""The targets of a step, each with the kinds of records that it stands for."""

_time = attrgetter("time")


@dataclass(frozen=True, slots=True)
class LostRecords:
    """Records that the trace lost between two reports of counts; the times are instants."""

    after: Ns
    until: Ns
    what: str
    count: int


@dataclass(frozen=True, slots=True)
class _Report:
    """The counts that the controller reported at one time of its own."""

    at: Ns
    seen: Observation


class ReplayedController:
    """The controller of a node, at any time of its own."""

    def __init__(self, analysis: Analysis, node: str, trace: NodeTrace, late: Ns) -> None:
        """``late``: how long after the first controller of all it started, in ns."""
        self.name, self.late = node, late
        self._analysis, self._seen = analysis, trace.seen
        self._simulated = trace.simulated
        records = sorted((*trace.seen.records, *trace.seen.values), key=_time)
        self._of: defaultdict[tuple[int, int], list[TraceRecord]] = defaultdict(list)
        for one in records:
            self._of[one.element.number, KINDS.index(one.kind)].append(one)
        self._listed = [one for one in records if one.kind in LISTED]
        self._steps = {
            what: [one for one in records if one.kind in kinds] for what, kinds in STEPS.items()
        }
        self._reports = [_report(trace.seen, lines) for lines in trace.reports]
        self._end = max((trace.seen.end, *(one.at for one in self._reports)))
        self._kept: dict[tuple[int, int, int], list[Point]] = {}
        self.gaps = tuple(self._gaps())
        self._histories = tuple(histories(analysis, trace.seen))

    @property
    def end(self) -> Ns:
        """The instant of the last line of its trace."""
        return Ns(self._end + self.late)

    @property
    def is_whole(self) -> bool:
        """Whether the controller ended in order, with its last counts in the trace."""
        return self._seen.complete

    def node(self, at: int) -> WatchedNode:
        """The node as a monitor shows it at an instant, with the counts of the last report."""
        now = Ns(max(NO_TIME, at - self.late))
        number = bisect_right(self._reports, now, key=lambda one: one.at)
        snapshot = self._snapshot(now, number)
        ended = now >= self._end
        shown = NodeMonitor(self._analysis, self.name).shown(snapshot, None if ended else 0)
        shown.now, shown.ended = now, ended and self._seen.complete
        if self._simulated:
            shown.not_seen = [SIMULATED if one == NO_COUNTS else one for one in shown.not_seen]
        elif not number:
            first = (
                f"before {rounded.instant(self._reports[0].at)} s" if self._reports else "at all"
            )
            counts = "counts of processors, queues of charts, faults and losses"
            missing = f"{counts}: the trace has none {first}"
            shown.not_seen = [missing if one == NO_COUNTS else one for one in shown.not_seen]
        return shown

    def counted(self, at: int) -> Ns | None:
        """When the counts were reported that are shown at an instant, in time of the controller."""
        number = bisect_right(self._reports, at - self.late, key=lambda one: one.at)
        return self._reports[number - 1].at if number else None

    def responses(self, at: int) -> list[RowHistogram]:
        """The responses of its activities, from its start to the last report before an instant."""
        return [one.at(at - self.late) for one in self._histories]

    def _snapshot(self, now: Ns, number: int) -> Snapshot:
        """The snapshot of a time: the records until then, and the counts of the report before."""
        listed = bisect_right(self._listed, now, key=_time)
        counts = self._reports[number - 1].seen if number else self._before_reports()
        seen = replace(
            counts,
            records=self._listed[max(0, listed - RECENT) : listed],
            digest=self._seen.digest,
            start=self._seen.start,
            complete=self._seen.complete and now >= self._end,
        )
        tallies = []
        for key in sorted(self._of):
            records = self._of[key]
            count = bisect_right(records, now, key=_time)
            if count:
                tallies.append(Tally(count, records[count - 1]))
        return Snapshot(number, seen, tuple(tallies))

    def _before_reports(self) -> Observation:
        """No counts. Where the first report has lost trace records, those before it have gaps."""
        lost = {TRACE: self._reports[0].seen.trace_lost} if self._reports else {}
        return Observation(self._seen.map, counts=lost)

    def records(self, at: int) -> Iterator[tuple[str, str, str]]:
        """The records of an instant: kind, element, and text."""
        records, now = self._steps["record"], at - self.late
        first, end = bisect_left(records, now, key=_time), bisect_right(records, now, key=_time)
        for one in records[first:end]:
            yield one.kind, one.element.name, _said(one)

    def step(self, at: int, what: str, *, back: bool) -> Ns | None:
        """The next instant that has such a record, or the one before; None where there is none."""
        records, now = self._steps[what], at - self.late
        index = bisect_left(records, now, key=_time) - 1
        if not back:
            index = bisect_right(records, now, key=_time)
        if not 0 <= index < len(records):
            return None
        return Ns(records[index].time + self.late)

    def count(self, what: str) -> int:
        """How many records a step of that kind can lead to."""
        return len(self._steps[what])

    def _gaps(self) -> Iterator[LostRecords]:
        """When trace records and recorded values were lost, and how many."""
        reports = [_Report(NO_TIME, Observation(self._seen.map)), *self._reports]
        for before, after in pairwise(reports):
            for what in (TRACE, VALUES):
                count = after.seen.counts.get(what, 0) - before.seen.counts.get(what, 0)
                if count:
                    times = Ns(before.at + self.late), Ns(after.at + self.late)
                    yield LostRecords(*times, what, count)

    def points(self, value: str, first: Ns, last: Ns) -> tuple[Quantity, Sequence[Point], int]:
        """The points of a value in a time, with the point before, which still holds then.

        Of very many points only those with the extremes remain; the number counts all.
        """
        element = self._seen.map.named(value, VALUE)
        quantity = Quantity.of(element.literals, element.unit)
        records = self._of[element.number, KINDS.index(VALUE)]
        start = max(0, bisect_right(records, first, key=_time) - 1)
        end = bisect_right(records, last, key=_time)
        if end - start <= MOST_POINTS:
            points = [(one.time, one.value) for one in records[start:end]]
            return quantity, points, len(points)
        grain = 4 * (last - first) // MOST_POINTS
        points, recorded = [], end - start
        while start < end:
            place = records[start].time // grain
            later = bisect_left(records, (place + 1) * grain, lo=start, key=_time)
            points += self._extremes(element.number, start, min(later, end))
            start = later
        return quantity, points, recorded

    def _extremes(self, number: int, start: int, end: int) -> list[Point]:
        """Those of some records of a value; kept, since a plot that moves asks again for most."""
        key = number, start, end
        if key not in self._kept:
            if len(self._kept) >= MOST_KEPT:
                self._kept.clear()
            records = self._of[number, KINDS.index(VALUE)][start:end]
            self._kept[key] = extremes([(one.time, one.value) for one in records])
        return self._kept[key]


def _report(trace: Observation, lines: Sequence[str]) -> _Report:
    """The counts of a report; one without an N line is of the end."""
    seen = read_trace(lines, trace.map)
    return _Report(trace.end if seen.now is None else seen.now, seen)


def _said(record: TraceRecord) -> str:
    """The value of a record in its unit, or its transition or fault."""
    if record.kind == VALUE:
        quantity = Quantity.of(record.element.literals, record.element.unit)
        return f"{quantity.text(record.value)} {quantity.unit}".rstrip()
    return "" if record.kind == "activity" else event_of(record).what


class ReplayedRun:
    """The controllers of a run, and where the replay of it is: it moves by a clock of its own."""

    def __init__(
        self,
        analysis: Analysis,
        traces: Mapping[str, NodeTrace],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """At the first instant, at rest. ``clock`` counts the seconds of the real time."""
        first = min(one.seen.start for one in traces.values())
        self.controllers = [
            ReplayedController(analysis, node, one, Ns(one.seen.start - first))
            for node, one in traces.items()
        ]
        self.end = Ns(max(one.end for one in self.controllers))
        self.speed = 1.0
        self._clock = clock
        self._from = NO_TIME
        self._since: float | None = None

    @property
    def at(self) -> Ns:
        """The instant that is shown."""
        if self._since is None:
            return self._from
        passed = (self._clock() - self._since) * self.speed * 1e9
        return min(self.end, Ns(self._from + int(passed)))

    @property
    def playing(self) -> bool:
        """Whether time goes on."""
        return self._since is not None and self.at < self.end

    def play(self) -> None:
        """Let time go on; from the beginning where the end was reached."""
        at = self.at
        self._from, self._since = at if at < self.end else NO_TIME, self._clock()

    def pause(self) -> None:
        """Stay at the instant that is shown."""
        self._from, self._since = self.at, None

    def set_speed(self, speed: float) -> None:
        """Let time go on so many times as fast as it did."""
        playing = self.playing
        self.pause()
        self.speed = speed
        if playing:
            self.play()

    def seek(self, at: int) -> None:
        """Go to an instant, the first or the last one where it is outside; time goes on or not."""
        playing = self.playing
        self._from, self._since = Ns(min(max(at, 0), self.end)), None
        if playing and self._from < self.end:
            self.play()

    def step(self, what: str, *, back: bool) -> bool:
        """Go to the next instant that has such a record, and stay there; False: there is none."""
        self.pause()
        found = [one.step(self.at, what, back=back) for one in self.controllers]
        there = [one for one in found if one is not None]
        if not there:
            return False
        self.seek(max(there) if back else min(there))
        return True
