# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The output of `ravenchart simulate`, as the trace that a run would have of it.

The lines say which states are entered and left, but neither final states nor where a chart
terminates: these follow from the transitions. A step leaves one record of a state for each
region, as the step of a controller does.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from operator import attrgetter

from ravenchart.analysis.system.observed import (
    VALUE,
    NumberedElement,
    Observation,
    TraceError,
    TraceMap,
    TraceRecord,
)
from ravenchart.behaviour.interpreter.traces import StepRecord, ValueRecord
from ravenchart.behaviour.tree import TOP, ChartTree, RegionKey
from ravenchart.gen.model.statechart import PseudoKind, TransitionKind
from ravenchart.gen.model.system import System
from ravenchart.running.chart_names import traced_chart

from .simulated import Charts, RecordedSeries, records_of, trees_by_chart


def observed_simulation(system: System, lines: Iterable[str], file: str) -> Observation:
    """States, transitions and values by number; TraceError where they do not fit the model."""
    charts = trees_by_chart(system)
    trace_map = _map(system, charts)
    followed = {chart: FollowedChart(tree) for chart, tree in charts.items()}
    elements = {(one.kind, one.name): one for one in trace_map.elements.values()}
    recorded = RecordedSeries(system)
    seen = Observation(trace_map, digest=system.digest, complete=True)
    for place, record in records_of(charts, lines, file):
        if isinstance(record, ValueRecord):
            recorded.take(record, place)
            continue
        one = followed[record.instance, record.region]
        wrong = one.take(record)
        if wrong is not None:
            raise TraceError(f"{place} {wrong}")
        top = elements["region", f"{record.instance}.{record.region}"]
        for name in one.taken:
            number = top.transitions.index(name)
            seen.records.append(TraceRecord(record.at, "transition", top, number))
        for key, leaf in one.leaves():
            element = elements["region", _traced(record.instance, record.region, key)]
            number = element.leaves.index(leaf)
            seen.records.append(TraceRecord(record.at, "state", element, number))
    for series in recorded.series():
        element = elements[VALUE, series.name]
        seen.values += [TraceRecord(at, VALUE, element, number) for at, number in series.points]
    seen.values.sort(key=attrgetter("time"))
    return seen


class FollowedChart:
    """Which states of a chart are active, by the behaviours of its steps."""

    def __init__(self, tree: ChartTree) -> None:
        """Before its first step."""
        self._tree = tree
        self._active: dict[RegionKey, str] = {}
        self._end: str | None = None
        self.taken: list[str] = []
        """The transitions of the last step, in order."""

    def take(self, record: StepRecord) -> str | None:
        """Go on by a step; what is wrong with it, if anything is."""
        self.taken = []
        for behaviour in record.behaviours:
            name, _, what = behaviour.rpartition(".")
            if what == "effect":
                self._pass(name)
            elif what == "entry":
                self._active[self._tree.slots[name]] = name
            elif self._active.get(self._tree.slots[name]) != name:
                return f"{name} is left, but was not active"
            else:
                self._leave(name)
        return None

    def _leave(self, name: str) -> None:
        """A state is left, and so is a final state in it, which no line names."""
        del self._active[self._tree.slots[name]]
        for region in self._tree.regions_of(name):
            self._active.pop(region, None)

    def _pass(self, name: str) -> None:
        """A transition; one to a final state enters it, and one to a terminate ends the chart."""
        transition = self._tree.transitions.get(name)
        if transition is None:
            return  # that of a region to its initial state
        self.taken.append(name)
        target = transition.target
        if transition.kind is TransitionKind.INTERNAL:
            return
        if self._tree.kinds.get(target) is PseudoKind.TERMINATE:
            self._end = target
        elif target in self._tree.states and self._tree.states[target].final:
            self._active[self._tree.slots[target]] = target

    def leaves(self) -> Iterator[tuple[RegionKey, str]]:
        """The active leaf of each region that has one, the outer regions first."""
        if self._end is not None:
            yield TOP, self._end
            return
        yield from self._leaves_in(TOP)

    def _leaves_in(self, region: RegionKey) -> Iterator[tuple[RegionKey, str]]:
        state = self._active.get(region) or self._default(region)
        if state is None:
            return
        if self._tree.is_innermost(state):
            yield self._tree.concurrent_region_around(region), state
        for nested in self._tree.regions_of(state):
            yield from self._leaves_in(nested)

    def _default(self, inner: RegionKey) -> str | None:
        """The final state that a region begins with."""
        region = self._tree.region
        initial = region.initial if inner == TOP else self._tree.nested[inner].initial
        state = self._tree.states.get(initial.target)
        return initial.target if state is not None and state.final else None


def _map(system: System, charts: Charts) -> TraceMap:
    """Regions and recorded values, numbered in the order of the model."""
    elements: list[NumberedElement] = []
    for (instance, name), tree in charts.items():
        origin = str(tree.region.origin)
        for key in reversed(tree.concurrent_regions):
            elements.append(
                NumberedElement(
                    number=len(elements) + 1,
                    name=_traced(instance, name, key),
                    kind="region",
                    origin=origin,
                    leaves=tuple(_leaves_of(tree, key)),
                    transitions=() if key.owner else tuple(tree.transitions),
                )
            )
    for one in system.recorded_values:
        number, origin = len(elements) + 1, str(one.of.item.origin)
        elements.append(
            NumberedElement(
                number, one.element, VALUE, origin, literals=one.literals, unit=one.unit
            )
        )
    return TraceMap(system.name, system.digest, {one.number: one for one in elements})


def _traced(instance: str, region: str, key: RegionKey) -> str:
    return traced_chart(instance, region, None if key.owner is None else key.name)


def _leaves_of(tree: ChartTree, key: RegionKey) -> Iterator[str]:
    """The leaves of a region; a terminate pseudostate is one of the top-level region."""
    for state in tree.states:
        if tree.concurrent_region_of[state] == key and tree.is_innermost(state):
            yield state
    if key.owner is None:
        yield from (name for name, kind in tree.kinds.items() if kind is PseudoKind.TERMINATE)
