# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The trace that `ravenchart simulate` prints, as text or as JSON lines, read again."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator

from ravenchart.analysis.system.observed import TraceError
from ravenchart.behaviour.interpreter.traces import (
    StepRecord,
    ValueRecord,
    parsed_record,
    parsed_value,
)
from ravenchart.behaviour.tree import TOP, ChartTree, RegionKey
from ravenchart.gen.language.terms import NO_TIME, Ns
from ravenchart.gen.model.system import System

from .timeline import Mark, Slice, Timeline, TraceRow, Track
from .values import Point, Quantity, Series

INITIAL = re.compile(r"initial\(\w+\)")
"""The initial transition of a region."""

NUMBER = re.compile(r"-?\d{1,19}")

Charts = dict[tuple[str, str], ChartTree]
"""By instance and region."""

STEP = re.compile(r"\d{1,12}\.\d{3,9} [\w.]+\.\w+: \S.*")
VALUE_LINE = re.compile(r"\d{1,12}\.\d{3,9} [\w.]+ = -?\w+")


def is_simulated(first: str) -> bool:
    """Whether a trace that begins with this line is of a simulation."""
    return first.startswith("{") or any(line.fullmatch(first) for line in (STEP, VALUE_LINE))


def of_simulation(system: System, lines: Iterable[str], file: str) -> Timeline:
    """The steps as states and transitions, and the values.

    TraceError for a line that does not fit the model.
    """
    found = Timeline(system.name)
    charts = trees_by_chart(system)
    active: dict[tuple[str, str, RegionKey], tuple[str, Ns]] = {}
    recorded = RecordedSeries(system)
    now = NO_TIME
    for where, record in records_of(charts, lines, file):
        now = record.at
        if isinstance(record, ValueRecord):
            recorded.take(record, where)
            continue
        tree = charts[record.instance, record.region]
        chart = f"{record.instance}.{record.region}"
        for behaviour in record.behaviours:
            found.rows.append(TraceRow(now, system.name, "behaviour", chart, behaviour))
            name, _, what = behaviour.rpartition(".")
            if what == "effect":
                found.marks.append(Mark(_track(found, chart, TOP), name, "transition", now))
                continue
            key = (record.instance, record.region, tree.slots[name])
            before = active.pop(key, None)
            if what == "entry":
                active[key] = (name, now)
            elif before is None or before[0] != name:
                raise TraceError(f"{where} {name} is left, but was not active")
            else:
                found.slices.append(Slice(_track(found, chart, key[2]), name, before[1], now))
    for (instance, region, inner), (name, start) in active.items():
        track = _track(found, f"{instance}.{region}", inner)
        found.slices.append(Slice(track, name, start, now, open=True))
    in_order = {track: index for index, track in enumerate(_tracks(system.name, charts))}
    found.tracks.sort(key=in_order.__getitem__)
    for series in recorded.series():
        found.take(series, now)
    found.rows.sort(key=lambda row: row.at or NO_TIME)
    found.take_states(system)
    return found


def trees_by_chart(system: System) -> Charts:
    """All charts of a system."""
    return {
        (instance.name, region.name): ChartTree(region)
        for instance in system.instances
        for region in instance.component.regions
    }


def records_of(
    charts: Charts, lines: Iterable[str], file: str
) -> Iterator[tuple[str, StepRecord | ValueRecord]]:
    """Each step and value in order of time, with the place that an error of it names.

    TraceError for a line that is none, and for a behaviour that no chart has.
    """
    now = NO_TIME
    for number, record in _records(lines, file):
        place = f"{file}:{number}: error:"
        if record.at < now:
            raise TraceError(f"{place} the time is before that of the line above")
        now = record.at
        if isinstance(record, StepRecord):
            tree = charts.get((record.instance, record.region))
            chart = f"{record.instance}.{record.region}"
            if tree is None:
                raise TraceError(f"{place} the model has no chart {chart}")
            for behaviour in record.behaviours:
                if not _has(tree, behaviour):
                    raise TraceError(f"{place} {chart} has no behaviour {behaviour}")
        yield place, record


def _has(tree: ChartTree, behaviour: str) -> bool:
    """Whether a chart has a behaviour of that name."""
    name, _, what = behaviour.rpartition(".")
    if what == "effect":
        return name in tree.transitions or INITIAL.fullmatch(name) is not None
    return what in ("entry", "exit") and name in tree.states


class RecordedSeries:
    """The values that a simulation has recorded, by element."""

    def __init__(self, system: System) -> None:
        self._process = system.name
        self._values = {one.element: one for one in system.recorded_values}
        self._points: dict[str, list[Point]] = {element: [] for element in self._values}

    def take(self, record: ValueRecord, place: str) -> None:
        """Add a value; TraceError where the model cannot have it."""
        known = self._values.get(record.element)
        if known is None:
            raise TraceError(f"{place} the model does not record {record.element}")
        text = str(record.value)
        if known.literals:
            number = known.literals.index(text) if text in known.literals else None
        else:
            number = int(text) if NUMBER.fullmatch(text) else None
        if number is None:
            raise TraceError(f"{place} {record.element} has no value {text}")
        self._points[record.element].append((record.at, number))

    def series(self) -> Iterator[Series]:
        """All of them, in the order of the model."""
        for element, one in self._values.items():
            points = tuple(self._points[element])
            yield Series(self._process, element, Quantity.of(one.literals, one.unit), points)


def _tracks(system: str, charts: Charts) -> Iterator[Track]:
    """The tracks of all regions: chart by chart, from the outside in."""
    for (instance, region), tree in charts.items():
        chart = f"{instance}.{region}"
        yield _named(system, chart, TOP)
        for state in tree.states:
            yield from (_named(system, chart, one) for one in tree.regions_of(state))


def _records(lines: Iterable[str], file: str) -> Iterator[tuple[int, StepRecord | ValueRecord]]:
    """Each step and value with the number of its line."""
    for number, line in enumerate(lines, 1):
        text = line.strip()
        if not text:
            continue
        try:
            yield number, _json(text) if text.startswith("{") else _text(text)
        except (KeyError, TypeError, ValueError):
            problem = f"not a line of `ravenchart simulate`: {text[:60]!r}"
            raise TraceError(f"{file}:{number}: error: {problem}") from None


def _text(line: str) -> StepRecord | ValueRecord:
    if VALUE_LINE.fullmatch(line) is not None:
        return parsed_value(line)
    if STEP.fullmatch(line) is None:
        raise ValueError(line)
    return parsed_record(line)


def _json(line: str) -> StepRecord | ValueRecord:
    raw = json.loads(line)
    at = raw["at_ns"]
    if not isinstance(at, int) or at < 0:
        raise ValueError(line)
    if "value" in raw:
        return ValueRecord(Ns(at), str(raw["element"]), str(raw["value"]))
    behaviours = raw["behaviours"]
    if not isinstance(behaviours, list):
        raise ValueError(line)
    names = tuple(str(one) for one in behaviours)
    return StepRecord(Ns(at), str(raw["instance"]), str(raw["region"]), names)


def _track(found: Timeline, chart: str, region: RegionKey) -> Track:
    """The track of a region in a chart, which is now in the timeline."""
    track = _named(found.system, chart, region)
    if track not in found.tracks:
        found.tracks.append(track)
    return track


def _named(system: str, chart: str, region: RegionKey) -> Track:
    """The track of a region in a chart: one state at most is active in it."""
    owner, nested = region
    inside = "" if owner is None else f" in {owner}{'.' if nested else ''}{nested}"
    return Track(system, chart + inside)
