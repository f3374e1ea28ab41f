# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The geometry of a chart, for interpreter and rules alike; its look-ups are made once.

The emitter has its own (`gen/model/chart`): the two are compared by the tests, and share no code.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

from ravenchart.gen.language.terms import InState, leaves
from ravenchart.gen.model.statechart import (
    After,
    Completion,
    Every,
    NestedRegion,
    OnEvent,
    PseudoKind,
    Pseudostate,
    Region,
    Segment,
    State,
    Transition,
    TransitionKind,
    When,
)


class RegionKey(NamedTuple):
    """A region inside a chart: the state that has it, and its name."""

    owner: str | None
    name: str


TOP = RegionKey(None, "")
"""The top-level region."""


@dataclass(frozen=True, slots=True)
class Occurrence:
    """The reason for a step: ``kind``, and the state, transition or event."""

    kind: str
    """``start``, ``completion``, ``time``, ``event``, ``conditions`` or ``done``."""
    subject: str = ""


START = Occurrence("start")
CONDITIONS = Occurrence("conditions")


@dataclass(frozen=True)
class ChartTree:
    """A region; ``working`` are the states with a do activity."""

    region: Region
    working: frozenset[str] = field(default_factory=frozenset)

    @cached_property
    def states(self) -> dict[str, State]:
        """The states by name, in tree order."""
        return {state.name: state for state in self.region.states}

    @cached_property
    def pseudostates(self) -> dict[str, Pseudostate]:
        """The pseudostates by name."""
        return {pseudo.name: pseudo for pseudo in self.region.pseudostates}

    @cached_property
    def kinds(self) -> dict[str, PseudoKind]:
        """The kind of each pseudostate."""
        return {name: pseudo.kind for name, pseudo in self.pseudostates.items()}

    @cached_property
    def slots(self) -> dict[str, RegionKey]:
        """The region that holds each vertex."""
        vertices: tuple[State | Pseudostate, ...] = (*self.region.states, *self.region.pseudostates)
        return {
            v.name: TOP if v.parent is None else RegionKey(v.parent, v.region) for v in vertices
        }

    @cached_property
    def chains(self) -> dict[str, tuple[str, ...]]:
        """Each vertex and its enclosing states, innermost first."""
        found: dict[str, tuple[str, ...]] = {}
        for name in self.slots:
            chain, at = [], self.slots[name].owner
            while at is not None:
                chain.append(at)
                at = self.slots[at].owner
            found[name] = (name, *chain)
        return found

    @cached_property
    def order(self) -> dict[str, int]:
        """The position of each state in tree order."""
        return {name: index for index, name in enumerate(self.states)}

    def ordered(self, names: Iterable[str]) -> tuple[str, ...]:
        """Some states, in tree order."""
        return tuple(sorted(names, key=self.order.__getitem__))

    @cached_property
    def nested(self) -> dict[RegionKey, NestedRegion]:
        """The regions of the states."""
        return {RegionKey(s.name, r.name): r for s in self.region.states for r in s.regions}

    @cached_property
    def concurrent_regions(self) -> tuple[RegionKey, ...]:
        """The orthogonal regions, inner before outer; last the top-level region."""
        return tuple(RegionKey(*one) for one in self.region.concurrent_regions())

    @cached_property
    def concurrent_region_of(self) -> dict[str, RegionKey]:
        """The innermost top-level or orthogonal region around each state."""
        return {name: RegionKey(*self.region.concurrent_region(name)) for name in self.states}

    @cached_property
    def asks_own(self) -> bool:
        """Whether a guard or condition asks for a state of the region itself."""
        triggers = [t.trigger for t in self.region.transitions]
        asking = [t.guard for t in self.region.transitions if t.guard is not None]
        asking += [one.condition for one in triggers if isinstance(one, When)]
        found = (leaf for expression in asking for leaf in leaves(expression))
        return any(isinstance(one, InState) and one.region == self.region.name for one in found)

    def determines(self, active: tuple[str, ...], state: str) -> bool:
        """Whether a configuration, or a part or union of parts, says if a state is active."""
        region = self.concurrent_region_of[state]
        if region.owner is None or any(self.concurrent_region_of[n] == region for n in active):
            return True
        return region.owner not in active and self.determines(active, region.owner)

    def concurrent_region_around(self, slot: RegionKey) -> RegionKey:
        """The top-level or orthogonal region in which the states of a region are."""
        if slot.owner is None or slot.owner in self.orthogonal:
            return slot
        return self.concurrent_region_of[slot.owner]

    @cached_property
    def orthogonal(self) -> frozenset[str]:
        """The states of several regions."""
        return frozenset(name for name, state in self.states.items() if state.is_orthogonal)

    def regions_of(self, state: str) -> tuple[RegionKey, ...]:
        """The regions of a state, in model order."""
        return tuple(RegionKey(state, region.name) for region in self.states[state].regions)

    def is_innermost(self, state: str) -> bool:
        """Whether a state is innermost in its orthogonal region: it has no region, or several."""
        return len(self.states[state].regions) != 1

    @cached_property
    def terminates(self) -> bool:
        """Whether some transition may stop the region."""
        return PseudoKind.TERMINATE in self.kinds.values()

    @cached_property
    def outgoing(self) -> dict[str, tuple[Transition, ...]]:
        """The transitions that leave each vertex, in model order, ``else`` last."""
        return {name: self.region.outgoing(name) for name in self.slots}

    @cached_property
    def incoming(self) -> dict[str, tuple[Transition, ...]]:
        """The transitions whose target is the vertex, for each vertex."""
        return {
            name: tuple(
                t
                for t in self.region.transitions
                if t.target == name and t.kind is not TransitionKind.INTERNAL
            )
            for name in self.slots
        }

    @cached_property
    def completing(self) -> frozenset[str]:
        """The states whose completion matters."""
        return frozenset(
            t.source for t in self.region.transitions if isinstance(t.trigger, Completion)
        )

    @cached_property
    def remembered(self) -> frozenset[RegionKey]:
        """The regions whose last leaf some history reads."""
        found: set[RegionKey] = set()
        for pseudo in self.region.pseudostates:
            if pseudo.kind is PseudoKind.HISTORY:
                found.add(self.slots[pseudo.name])
            elif pseudo.kind is PseudoKind.DEEP_HISTORY:
                around = self.slots[pseudo.name]
                found |= {around, *(s for s in self.nested if self.inside(s, around))}
        return frozenset(found)

    def inner_regions(self, vertex: str) -> Iterator[RegionKey]:
        """The regions that a vertex is in, as far as that of an orthogonal state around it."""
        for name in self.chains[vertex]:
            yield self.slots[name]
            owner = self.slots[name].owner
            if owner is not None and self.states[owner].is_orthogonal:
                return

    @cached_property
    def default(self) -> tuple[str, ...]:
        """The states entered by default: a region publishes them before its first execution."""
        found: set[str] = set()
        waiting: list[RegionKey] = [TOP]
        while waiting:
            slot = waiting.pop()
            initial = self.region.initial if slot == TOP else self.nested[slot].initial
            path = [n for n in self.path(initial.target, slot) if n in self.states]
            found.update(path)
            inside = {self.slots[name] for name in path}
            waiting += [s for s in self.nested if s.owner in path and s not in inside]
        return tuple(name for name in self.states if name in found)

    def inside(self, slot: RegionKey, around: RegionKey) -> bool:
        """Whether the owner of a region is in another."""
        owner = slot.owner
        return owner is not None and any(self.slots[s] == around for s in self.chains[owner])

    def path(self, vertex: str, boundary: RegionKey) -> tuple[str, ...]:
        """The vertices from inside a region down to one in it, outer first."""
        chain: list[str] = []
        for name in self.chains[vertex]:
            chain.append(name)
            if self.slots[name] == boundary:
                return tuple(reversed(chain))
        raise ValueError(f"{vertex} is not in {boundary}")

    def below(self, state: str, vertex: str) -> RegionKey:
        """The region of a state in which a vertex is, at any depth."""
        return next(self.slots[n] for n in self.chains[vertex] if self.slots[n].owner == state)

    def around(self, vertex: str) -> tuple[str, ...]:
        """The states around a vertex, innermost first."""
        return self.chains[vertex][1:]

    def regions_around(self, vertex: str) -> tuple[RegionKey, ...]:
        """The regions that a vertex is in, innermost first."""
        return tuple(self.slots[name] for name in self.chains[vertex])

    def common(self, first: str, *others: str) -> RegionKey:
        """The innermost region that holds all: an external transition leaves states inside it."""
        around = [self.regions_around(vertex) for vertex in others]
        return next(
            one for one in self.regions_around(first) if all(one in other for other in around)
        )

    def around_all(self, vertices: tuple[str, ...]) -> str:
        """The innermost state around all of them."""
        first, *others = vertices
        return next(
            s for s in self.around(first) if all(s in self.around(other) for other in others)
        )

    @cached_property
    def transitions(self) -> dict[str, Transition]:
        """The transitions and segments by name, in model order."""
        return {t.name: t for t in self.region.transitions}

    def source_of(self, transition: str) -> str:
        """Where a transition starts."""
        return self.transitions[transition].source

    @cached_property
    def _triggered(self) -> dict[tuple[str, Occurrence], tuple[Transition, ...]]:
        return {}

    def triggered(self, state: str, occurrence: Occurrence) -> tuple[Transition, ...]:
        """The transitions of a state that an occurrence triggers, guards aside."""
        key = (state, occurrence)
        if key not in self._triggered:
            leaving = self.outgoing[state]
            self._triggered[key] = tuple(t for t in leaving if occurs(t, occurrence))
        return self._triggered[key]


def occurs(transition: Transition, occurrence: Occurrence) -> bool:
    """Whether an occurrence triggers a transition, guards and conditions aside."""
    match transition.trigger:
        case OnEvent(event):
            return occurrence.kind == "event" and occurrence.subject == event
        case After() | Every():
            return occurrence.kind == "time" and occurrence.subject == transition.name
        case When():
            return occurrence.kind == "conditions"
        case Completion():
            return occurrence.kind == "completion" and occurrence.subject == transition.source
        case Segment():
            return False
