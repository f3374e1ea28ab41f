# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The view that a monitor has of a running controller: a snapshot beside model and bounds."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field

from ravenchart.analysis.present.report import compare
from ravenchart.analysis.system.observed import VALUE, TraceRecord
from ravenchart.analysis.system.row_responses import RowHistogram
from ravenchart.analysis.system.timing import Analysis
from ravenchart.described import Described
from ravenchart.gen.model.component import PortKind

from .snapshots import Snapshot, Tally
from .traces.timeline import around
from .traces.values import Quantity

LISTED = ("transition", "fault")
"""The kinds of records that a snapshot lists one by one."""

REAL_TIME = (os.SCHED_FIFO, os.SCHED_RR)

VALUES_NOT_SEEN = "values of ports, data and events"
OTHER_VALUES = "values of events, and of ports and data that `record` does not name"
NOT_FROM_START = (
    "what was before the monitor began: the controller ran already; a state is shown from the next "
    "record of its chart on"
)
"""Facts that are not seen of a controller that ran already."""

NO_COUNTS = (
    "processors, and queues of charts: they are reported by a program that `ravenchart build` has "
    "linked"
)
"""Facts that are not seen where a snapshot has no counts."""

OLDER_PROGRAM = (
    "the last response of a processor, and queues of charts: an older Ravenchart has generated the "
    "program"
)
"""Facts that are not seen where the counts of a snapshot lack them."""


@dataclass(slots=True)
class WatchedProcessor(Described):
    """A processor, from its start to the snapshot."""

    name: str
    """Its name."""
    due: int | None
    """How many releases were due, by the model; null where a bus releases it."""
    completed: int
    """How many releases have completed."""
    misses: int
    """How many of these completed after their deadline."""
    last_response: int | None
    """The response of the release that completed last, in ns; null where an older program does not
    report it."""
    worst_response: int
    """The longest response, in ns."""
    bound: int | None
    """The response-time bound R, in ns; null where the analysis has none."""
    word: str
    """`ok`, `MISS`, `ABOVE` the bound, or `host`: no more above it than the host withheld."""


@dataclass(slots=True)
class WatchedRow(Described):
    """An activity of a processor's table."""

    name: str
    """Its name."""
    executions: int
    """How many executions have begun."""
    longest_execution: int
    """The longest that has completed, in ns of processor time."""


@dataclass(slots=True)
class WatchedChart(Described):
    """A region: the chart of an instance, or a region of an orthogonal state."""

    name: str
    """Instance and region."""
    state: str | None
    """The active leaf state; null while the state around the region is not active."""
    since: int | None
    """When it was entered, in ns; null as `state`."""
    transitions: int
    """How many transitions were taken, those of its orthogonal states included."""
    taken: str | None
    """The transition that was taken last; null before the first."""


@dataclass(slots=True)
class WatchedEvent(Described):
    """A transition that was taken, or a fault."""

    at: int
    """When, in ns."""
    element: str
    """The chart; of a fault the processor, port, chart or message."""
    what: str
    """The name of the transition or the fault."""
    kind: str
    """`transition` or `fault`."""


@dataclass(slots=True)
class WatchedTraffic(Described):
    """The traffic of a port, event, message or controller of a bus."""

    name: str
    """Its name."""
    kind: str
    """`port`, `event`, `message` or `bus`."""
    what: str
    """`sent`, `arrived`, `handled`, `raised`, or the `state` of a controller."""
    count: int
    """How often."""
    last: int
    """When it was so last, in ns."""
    state: str | None
    """Of a controller its state; else null."""


@dataclass(slots=True)
class WatchedQueue(Described):
    """The queue of a port, from what has arrived and was handled; or that of a chart."""

    name: str
    """The port or the region."""
    waiting: int | None
    """How many elements wait; null where it is not known: trace records were lost or not read, or
    the port has `max_age`."""
    highest: int | None
    """The most that ever waited; null for a port."""
    depth: int
    """How many it holds."""
    faults: int
    """How many faults it had: overflows, and stale values where the port has `max_age`."""


@dataclass(slots=True)
class WatchedValue(Described):
    """The last value of a port or data item, where the model records it."""

    name: str
    """Its name; of a record that of one field."""
    value: str
    """The name of the literal, or the number in the unit."""
    unit: str
    """The unit; empty where there is none."""
    count: int
    """How many values were recorded."""
    last: int
    """When the last one was recorded, in ns."""


@dataclass(slots=True)
class WatchedNode(Described):
    """A controller, by its last snapshot. Times count from its start."""

    node: str
    """The name of the node."""
    process: int | None
    """The number of the process; null when it has ended, 0 where it cannot be seen."""
    ended: bool
    """Whether it ended in order: then the counts are those of its report."""
    real_time: bool | None
    """Whether its threads have real-time priorities; null where that cannot be seen."""
    sequence: int
    """The number of the snapshot, from 1."""
    now: int
    """The time of the snapshot, in ns."""
    processors: list[WatchedProcessor]
    """The one closest to its bound first."""
    rows: list[WatchedRow]
    """In the order of the model."""
    charts: list[WatchedChart]
    """In the order of the model."""
    events: list[WatchedEvent]
    """Transitions and faults that no line before had, the oldest first."""
    unlisted: int
    """How many more there were since the line before: no snapshot that was looked at lists them."""
    missed: int
    """How many snapshots were written since the line before and not looked at."""
    traffic: list[WatchedTraffic]
    """In the order of the model."""
    queues: list[WatchedQueue]
    """Those of queued ports, then those of charts."""
    values: list[WatchedValue]
    """The recorded values, in the order of the model."""
    faults: dict[str, int]
    """How many faults of each kind there were."""
    lost: dict[str, int]
    """The losses: trace records, frames, and records without room in the snapshot."""
    not_seen: list[str]
    """The facts that a monitor cannot see of this controller."""
    said: list[str] = field(default_factory=list)
    """Other lines of the controller of a board: why it ended, for example."""
    responses: list[RowHistogram] = field(default_factory=list)
    """The observed responses of activities, in the order of the tables."""
    responses_note: str = ""
    """The source of these responses, and what is missing."""


@dataclass(slots=True)
class Overlooked:
    """How much was not seen of a controller since its first snapshot that was looked at."""

    of: int = 0
    """How many snapshots it has written since then, that one included."""
    snapshots: int = 0
    """How many of these were not looked at."""
    events: int = 0
    """How many transitions and faults no snapshot lists that was looked at."""

    def add(self, node: WatchedNode, *, new: bool) -> None:
        """One look more; ``new``: at another snapshot than the look before."""
        self.of += node.missed + new
        self.snapshots += node.missed
        self.events += node.unlisted


class NodeMonitor:
    """Turns the snapshots of one node into what is shown; it knows what was shown before."""

    def __init__(self, analysis: Analysis, node: str, listed: int | None = None) -> None:
        """``listed``: how many transitions and faults it has shown; None where others may have."""
        self._analysis = analysis
        self._system = analysis.system
        self._node = node
        self._listed = listed
        self._sequence: int | None = None
        self._processors = {p.name.lower(): p for p in self._system.processors}

    def shown(self, snapshot: Snapshot, process: int | None) -> WatchedNode:
        """The controller of a ``process``, as a snapshot shows it."""
        seen = snapshot.seen
        now = seen.now or 0
        events, unlisted = self._new(snapshot)
        before = snapshot.sequence if self._sequence is None else self._sequence
        self._sequence = snapshot.sequence
        tallies = {(t.last.element.name, t.last.kind): t for t in snapshot.tallies}
        return WatchedNode(
            node=self._node,
            process=process,
            ended=seen.complete,
            real_time=_has_real_time(process),
            sequence=snapshot.sequence,
            now=now,
            processors=[
                WatchedProcessor(
                    one.task, self._due(one.task, now), one.releases, one.misses,
                    seen.processors[one.task].last_response, one.observed, one.bound, one.word,
                )
                for one in compare(self._analysis, seen)
            ],
            rows=[
                WatchedRow(name, _count(tallies.get((name, "activity"))), longest)
                for name, longest in seen.executions.items()
            ],
            charts=list(self._charts(snapshot, tallies)),
            events=[event_of(one) for one in events],
            unlisted=unlisted,
            missed=max(0, snapshot.sequence - before - 1),
            traffic=[
                WatchedTraffic(
                    t.last.element.name, t.last.element.kind, t.last.kind, t.count, t.last.time,
                    t.last.text if t.last.kind == "state" else None,
                )
                for t in snapshot.tallies
                if t.last.kind in ("sent", "arrived", "handled", "raised")
                or t.last.element.kind == "bus"
            ],
            queues=[*self._queues(snapshot, tallies), *self._chart_queues(snapshot, tallies)],
            values=[_value(t) for t in snapshot.tallies if t.last.kind == VALUE],
            faults={kind: n for kind, n in seen.faults.items() if n},
            lost={what: n for what, n in seen.losses.items() if n},
            not_seen=list(self._not_seen(snapshot)),
        )  # fmt: skip

    def _new(self, snapshot: Snapshot) -> tuple[list[TraceRecord], int]:
        """The transitions and faults since the snapshot before, and how many are not listed."""
        total = sum(t.count for t in snapshot.tallies if t.last.kind in LISTED)
        records = snapshot.seen.records
        came = len(records) if self._listed is None else total - self._listed
        self._listed = total
        new = records[-came:] if came > 0 else []
        return new, came - len(new)

    def _due(self, name: str, now: int) -> int | None:
        """How many releases of a processor were due by then."""
        processor = self._processors.get(name.lower())
        if processor is None or processor.released_by is not None:
            return None
        return max(0, (now - processor.offset) // processor.period + 1)

    def _charts(
        self, snapshot: Snapshot, tallies: dict[tuple[str, str], Tally]
    ) -> Iterator[WatchedChart]:
        if not tallies:
            return
        states = {name: t.last for (name, kind), t in tallies.items() if kind == "state"}
        for element in snapshot.seen.map.of_kind("region"):
            last = states.get(element.name) if self._active(element.name, states) else None
            taken = tallies.get((element.name, "transition"))
            yield WatchedChart(
                element.name,
                None if last is None else last.text,
                None if last is None else last.time,
                _count(taken),
                None if taken is None else taken.last.text,
            )

    def _active(self, region: str, states: Mapping[str, TraceRecord]) -> bool:
        """Whether all states around a region are active."""
        outside = around(self._system.instances, region)
        if outside is None:
            return True
        outer, state = outside
        return outer in states and states[outer].text == state and self._active(outer, states)

    def _queues(
        self, snapshot: Snapshot, tallies: dict[tuple[str, str], Tally]
    ) -> Iterator[WatchedQueue]:
        gaps = snapshot.partial or snapshot.seen.trace_lost > 0
        names = {element.name for element in snapshot.seen.map.of_kind("port")}
        for instance in self._system.instances:
            for port in instance.component.inputs():
                name = f"{instance.name}.{port.name}"
                if port.kind is not PortKind.QUEUED or name not in names or not tallies:
                    continue
                arrived, handled, lost = (
                    _count(tallies.get((name, kind))) for kind in ("arrived", "handled", "fault")
                )
                unknown = gaps or port.max_age is not None  # staleness is a fault, too
                waiting = None if unknown else max(0, arrived - handled - lost)
                yield WatchedQueue(name, waiting, None, port.depth, lost)

    def _chart_queues(
        self, snapshot: Snapshot, tallies: dict[tuple[str, str], Tally]
    ) -> Iterator[WatchedQueue]:
        for instance in self._system.instances:
            for region in instance.component.regions:
                name = f"{instance.name}.{region.name}"
                fill = snapshot.seen.queues.get(name)
                if fill is not None:
                    faults = _count(tallies.get((name, "fault")))
                    yield WatchedQueue(name, fill.waiting, fill.highest, region.queue_depth, faults)

    def _not_seen(self, snapshot: Snapshot) -> Iterator[str]:
        records = bool(snapshot.seen.map.of_kind(VALUE))
        yield OTHER_VALUES if records else VALUES_NOT_SEEN
        if snapshot.partial:
            yield NOT_FROM_START
        if not snapshot.tallies:
            yield "states, transitions, messages and faults by element: no record of a trace came"
        if snapshot.seen.losses.get("snapshot"):
            yield "what found no room in a snapshot: `lost` counts it"
        processors = snapshot.seen.processors.values()
        if not processors:
            yield NO_COUNTS
        elif any(one.last_response is None for one in processors):
            yield OLDER_PROGRAM


def _count(tally: Tally | None) -> int:
    return 0 if tally is None else tally.count


def _value(tally: Tally) -> WatchedValue:
    last = tally.last
    quantity = Quantity.of(last.element.literals, last.element.unit)
    text = quantity.text(last.value)
    return WatchedValue(last.element.name, text, quantity.unit, tally.count, last.time)


def event_of(record: TraceRecord) -> WatchedEvent:
    """A transition or fault, with its name."""
    what = record.fault or record.text
    return WatchedEvent(record.time, record.element.name, what, record.kind)


def _has_real_time(process: int | None) -> bool | None:
    if process:
        with suppress(OSError):
            return os.sched_getscheduler(process) in REAL_TIME
    return None
