# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A trace as tracks of slices and marks, and as rows: what the formats are made of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest

from ravenchart.analysis.system.observed import VALUE, NumberedElement, Observation, Visit
from ravenchart.gen.language.terms import NO_TIME, Ns
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import Processor, System

from .values import Point, Quantity, Series, series_of, spans

INACTIVE = "-"
"""Stands for a state where none is active."""

Arguments = dict[str, int | float | str | bool]


@dataclass(frozen=True, slots=True)
class Track:
    """A line of the picture; ``process`` is a node, or the model of a simulation."""

    process: str
    name: str


@dataclass(frozen=True, slots=True)
class Slice:
    """A time for which something was so; ``open``: it still was at the end of the trace."""

    track: Track
    name: str
    start: Ns
    end: Ns
    open: bool = False
    kind: str = "state"


@dataclass(frozen=True, slots=True)
class Mark:
    """Something that happened at one time."""

    track: Track
    name: str
    kind: str
    at: Ns
    more: Arguments = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class TraceRow:
    """A record as a row; of a count at the end of a run, ``detail`` is the number.

    A recorded value counts in the ``unit``.
    """

    at: Ns | None
    process: str
    kind: str
    element: str
    detail: str
    unit: str = ""


@dataclass(slots=True)
class Timeline:
    """A whole trace; ``lost`` counts what the trace says was lost, ``gaps`` its own records."""

    system: str
    rows: list[TraceRow] = field(default_factory=list)
    tracks: list[Track] = field(default_factory=list)
    slices: list[Slice] = field(default_factory=list)
    marks: list[Mark] = field(default_factory=list)
    series: list[Series] = field(default_factory=list)
    """The recorded values, by element."""
    states: list[Series] = field(default_factory=list)
    """The states of the regions that are recorded."""
    lost: dict[str, int] = field(default_factory=dict)
    gaps: int = 0
    values_lost: int = 0
    complete: bool = True
    """Of a run: it ended by itself, and the counts of its end are there."""

    def take(self, series: Series, end: Ns) -> None:
        """Add recorded values, until the end of the trace."""
        quantity = series.quantity
        self.series.append(series)
        for at, number in series.points:
            text = quantity.text(number)
            self.rows.append(TraceRow(at, series.process, VALUE, series.name, text, quantity.unit))
        if quantity.literals:
            track = Track(series.process, series.name)
            self.tracks.append(track)
            for number, start, stop, still in spans(series.points, end):
                self.slices.append(Slice(track, quantity.text(number), start, stop, still, VALUE))

    def take_states(self, system: System) -> None:
        """Add what the recorded regions show as slices, each track by itself."""
        regions = [one.element for one in system.recorded if isinstance(one.item, Region)]
        for track in self.tracks:
            slices = [one for one in self.slices if one.track == track and one.kind == "state"]
            if slices and any(_is_in(track.name, region) for region in regions):
                self.states.append(_states(track, slices))


def _is_in(track: str, region: str) -> bool:
    """Whether a track is that of a region, or of one inside its states."""
    return track == region or track.startswith((f"{region}.", f"{region} in "))


def _states(track: Track, slices: Sequence[Slice]) -> Series:
    """States as a value over time; `-` where none of the track is active."""
    literals = dict.fromkeys(one.name for one in slices)
    numbers = {name: number for number, name in enumerate((*literals, INACTIVE))}
    points: list[Point] = []
    for one, later in zip_longest(slices, slices[1:]):
        points.append((one.start, numbers[one.name]))
        if not one.open and (later is None or later.start > one.end):
            points.append((one.end, numbers[INACTIVE]))
    return Series(track.process, track.name, Quantity.of(tuple(numbers), None), tuple(points))


def of_run(system: System, parts: dict[str, Observation]) -> Timeline:
    """The timeline of runs of a system's nodes; times count from the first start of all."""
    found = Timeline(system.name)
    first = min(part.start for part in parts.values())
    several = len(parts) > 1
    for node, part in parts.items():
        late = Ns(part.start - first)
        _Run(system, node, part, late, found).add()
        lost = {f"{node}.{what}" if several else what: n for what, n in part.losses.items()}
        found.lost |= {what: n for what, n in lost.items() if n}
        found.gaps += part.trace_lost
        found.values_lost += part.values_lost
        found.complete = found.complete and part.complete
    found.rows.sort(key=lambda row: (row.at is None, row.at or NO_TIME))
    found.take_states(system)
    return found


@dataclass(frozen=True, slots=True)
class _Run:
    """The trace of one node, put into a timeline."""

    system: System
    node: str
    seen: Observation
    late: Ns
    found: Timeline

    def add(self) -> None:
        """All of it: processors first, then charts and controllers, then what is left."""
        rows = {
            slot.element: processor.name
            for processor in self.system.processors
            for slot in processor.slots
        }
        for processor in self.system.processors:
            if processor.node == self.node:
                self._processor(processor)
        for element in (*self.seen.map.of_kind("region"), *self.seen.map.of_kind("bus")):
            self._states(element)
        for record in self.seen.records:
            name = record.element.name
            at = self._time(record.time)
            self.found.rows.append(TraceRow(at, self.node, record.kind, name, record.text))
            match record.kind:
                case "activity":
                    self._mark(rows.get(name, name), name, "row", at)
                case "state":
                    pass
                case "transition":
                    self._mark(name, record.text, "transition", at)
                case kind:
                    owner = name.rpartition(".")[0]
                    where = owner if record.element.kind in ("port", "event") else name
                    self._mark(where, f"{kind} {name}", kind, at, value=record.value)
        self._values()
        self._counts()

    def _values(self) -> None:
        """The recorded values: those of an enumeration are slices as well."""
        for series in series_of(self.seen, self.node, self.late):
            self.found.take(series, self._time(self.seen.end))

    def _time(self, time: Ns) -> Ns:
        return Ns(time + self.late)

    def _track(self, name: str) -> Track:
        track = Track(self.node, name)
        if track not in self.found.tracks:
            self.found.tracks.append(track)
        return track

    def _mark(self, track: str, name: str, kind: str, at: Ns, **more: int | str) -> None:
        self.found.marks.append(Mark(self._track(track), name, kind, at, dict(more)))

    def _processor(self, processor: Processor) -> None:
        """The releases that it has counted, when the model says that they were due."""
        counts = self.seen.processors.get(processor.name)
        self._track(processor.name)
        if counts is None or processor.released_by is not None:
            return
        for number in range(counts.releases):
            at = self._time(Ns(processor.offset + number * processor.period))
            self._mark(processor.name, "due", "release", at, number=number)

    def _states(self, element: NumberedElement) -> None:
        """The stays of a chart, a region of an orthogonal state, or a controller of a bus."""
        visits = self._stays(element.name)
        if not visits:
            return
        track = self._track(element.name)
        for visit in visits:
            end = self.seen.end if visit.end is None else visit.end
            times = self._time(visit.start), self._time(end)
            self.found.slices.append(Slice(track, visit.state, *times, visit.end is None))

    def _stays(self, name: str) -> Sequence[Visit]:
        """Those in a region of an orthogonal state are cut to the times of that state."""
        visits, outside = self.seen.visits(name), around(self.system.instances, name)
        if outside is None:
            return visits
        outer, state = outside
        return tuple(_common(visits, [v for v in self._stays(outer) if v.state == state]))

    def _counts(self) -> None:
        """The counts of the end."""
        now = self.seen.end if self.seen.now is None else self.seen.now
        at = self._time(now)
        for name, one in self.seen.processors.items():
            worst = one.worst_response
            for kind, number in (
                ("releases", one.releases), ("misses", one.misses), ("worst_response_ns", worst),
            ):  # fmt: skip
                self._count(kind, name, number)
            times = {"worst_response_us": worst / 1000}
            if one.last_response is not None:
                self._count("last_response_ns", name, one.last_response)
                times["last_response_us"] = one.last_response / 1000
            counts: Arguments = {"releases": one.releases, "misses": one.misses, **times}
            self.found.marks.append(Mark(self._track(name), "counts", "counts", at, counts))
        for name, longest in self.seen.executions.items():
            self._count("longest_execution_ns", name, longest)
        for name, fill in self.seen.queues.items():
            self._count("most_waiting", name, fill.highest)
        for name, number in self.seen.faults.items():
            self._count("faults", name, number)
        for name, number in self.seen.losses.items():
            self._count("lost", name, number)
            if number:
                self._mark("losses", f"lost: {name}", "lost", at, number=number)

    def _count(self, kind: str, element: str, number: int) -> None:
        self.found.rows.append(TraceRow(None, self.node, kind, element, str(number)))


def around(instances: Sequence[Instance], name: str) -> tuple[str, str] | None:
    """Of a traced region ``instance.Region.Nested``: the region around it, and the state there."""
    instance = next((one for one in instances if name.startswith(f"{one.name}.")), None)
    if instance is None:
        return None
    owner = instance.name
    top, _, nested = name.removeprefix(f"{owner}.").partition(".")
    if not nested:
        return None
    region = next(one for one in instance.component.regions if one.name == top)
    inner = region.concurrent_regions()
    state = next(one.owner for one in inner if one.owner and one.name == nested)
    outer = region.concurrent_region(state)
    inside = "" if outer.owner is None else f".{outer.name}"
    return f"{owner}.{top}{inside}", state


def _common(visits: Sequence[Visit], outside: Sequence[Visit]) -> Iterator[Visit]:
    """The stays, cut to the times of others."""
    for visit in visits:
        for other in outside:
            start = Ns(max(visit.start, other.start))
            ends = [one.end for one in (visit, other) if one.end is not None]
            end = min(ends) if ends else None
            if end is None or start < end:
                yield Visit(visit.state, start, end)
