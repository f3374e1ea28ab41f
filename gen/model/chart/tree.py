# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The tree of a chart: the region of each vertex, and the states between two vertices.

Everything is looked up, nothing is searched for.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from ravenchart.gen.language.terms import Flow
from ravenchart.gen.model.statechart import (
    Initial,
    PseudoKind,
    Pseudostate,
    Region,
    RegionId,
    Segment,
    State,
    Transition,
    TransitionKind,
)
from ravenchart.gen.origins import Origin


class EntryFlow(NamedTuple):
    """One behaviour on the way in: of a state, or (None) of an initial transition."""

    state: str | None
    flow: Flow


@dataclass(frozen=True)
class Tree:
    """A region with its vertices by name."""

    region: Region

    # --- vertices

    @cached_property
    def states(self) -> Mapping[str, State]:
        """All states."""
        return {state.name: state for state in self.region.states}

    @cached_property
    def pseudostates(self) -> Mapping[str, Pseudostate]:
        """All pseudostates."""
        return {pseudo.name: pseudo for pseudo in self.region.pseudostates}

    def kind(self, vertex: str) -> PseudoKind | None:
        """The kind of a pseudostate; None for a state."""
        return self.pseudostates[vertex].kind if vertex in self.pseudostates else None

    def origin(self, vertex: str) -> Origin:
        """Where it is declared."""
        return (self.pseudostates.get(vertex) or self.states[vertex]).origin

    @cached_property
    def content(self) -> Mapping[RegionId, tuple[State, ...]]:
        """The states that stand directly in each region, in model order."""
        found: dict[RegionId, list[State]] = {}
        for state in self.region.states:
            found.setdefault(self.region.region_of(state.name), []).append(state)
        return {region: tuple(states) for region, states in found.items()}

    def initial(self, region: RegionId) -> Initial:
        """Where a region begins."""
        if region.owner is None:
            return self.region.initial
        return self.states[region.owner].nested(region.name).initial

    def regions(self, state: str) -> tuple[RegionId, ...]:
        """The regions of a state."""
        return self.states[state].region_ids

    # --- what is around

    def above(self, vertex: str) -> tuple[str, ...]:
        """The states around a vertex, innermost first."""
        return tuple(r.owner for r in self.region.regions_around(vertex) if r.owner is not None)

    def child(self, region: RegionId, vertex: str) -> str | None:
        """The vertex directly in a region that is the given one or holds it; None for neither."""
        at: str | None = vertex
        while at is not None:
            here = self.region.region_of(at)
            if here == region:
                return at
            at = here.owner
        return None

    def is_orthogonal(self, state: str) -> bool:
        """More regions than one."""
        return len(self.states[state].regions) > 1

    def divide(self, vertices: tuple[str, ...]) -> str | None:
        """The orthogonal state that has each of several vertices in another of its regions."""
        first, *others = vertices
        for state in self.above(first):
            if all(state in self.above(other) for other in others):
                held = {r for v in vertices for r in self.regions(state) if self.child(r, v)}
                return state if len(held) == len(vertices) else None
        return None

    # --- transitions

    @cached_property
    def outgoing(self) -> Mapping[str, tuple[Transition, ...]]:
        """The transitions that leave each vertex, in model order, ``else`` last."""
        found: dict[str, list[Transition]] = {}
        for transition in sorted(self.region.transitions, key=lambda t: t.otherwise):
            found.setdefault(transition.source, []).append(transition)
        return {vertex: tuple(leaving) for vertex, leaving in found.items()}

    @cached_property
    def incoming(self) -> Mapping[str, tuple[Transition, ...]]:
        """The transitions that lead to each vertex, in model order."""
        found: dict[str, list[Transition]] = {}
        for transition in self.region.transitions:
            found.setdefault(transition.target, []).append(transition)
        return {vertex: tuple(leading) for vertex, leading in found.items()}

    def domain(self, source: str, target: str) -> RegionId:
        """The innermost region that holds both ends: what is left and entered is inside it."""
        around = self.region.regions_around(target)
        return next(region for region in self.region.regions_around(source) if region in around)

    def ways(self, transition: Transition) -> Iterator[Way]:
        """The compound transitions that begin with a transition: one for each path of junctions."""
        for path in self._paths((transition,)):
            yield Way(self, path)

    def _paths(self, path: tuple[Transition, ...]) -> Iterator[tuple[Transition, ...]]:
        target = path[-1].target
        if self.kind(target) is not PseudoKind.JUNCTION:
            yield path
            return
        for segment in self.outgoing.get(target, ()):
            yield from self._paths((*path, segment))

    # --- entries

    def entries(self, region: RegionId, targets: tuple[str, ...]) -> Iterator[EntryFlow]:
        """The behaviours on entering a region on the way to ``targets``; with none, by default.

        A target that is a pseudostate ends the way in its region.
        """
        if not targets:
            initial = self.initial(region)
            yield EntryFlow(None, initial.effect)
            targets = (initial.target,)
        child = self.child(region, targets[0])
        if child is None or child not in self.states:
            return
        yield EntryFlow(child, self.states[child].entry)
        for nested in self.regions(child):
            yield from self.entries(nested, tuple(t for t in targets if self.child(nested, t)))


@dataclass(frozen=True)
class Way:
    """A compound transition up to a state, choice, history, fork, join or terminate."""

    tree: Tree
    path: tuple[Transition, ...]

    @property
    def target(self) -> str:
        """Where it leads."""
        return self.path[-1].target

    @property
    def source(self) -> str:
        """The state that it leaves: that around the sources, where a join comes first."""
        source = self.path[0].source
        if self.tree.kind(source) is not PseudoKind.JOIN:
            return source
        sources = tuple(t.source for t in self.tree.incoming.get(source, ()))
        return self.tree.divide(sources) or source

    @property
    def targets(self) -> tuple[str, ...]:
        """Where it leads, beyond a fork: several states."""
        if self.tree.kind(self.target) is not PseudoKind.FORK:
            return (self.target,)
        return tuple(t.target for t in self.tree.outgoing.get(self.target, ()))

    @property
    def is_internal(self) -> bool:
        """Nothing is left or entered."""
        return self.path[0].kind is TransitionKind.INTERNAL

    @cached_property
    def domain(self) -> RegionId:
        """The region inside which it leaves and enters."""
        first = self.path[0]
        end = self.targets[0]
        if self.tree.kind(self.target) is PseudoKind.FORK:
            end = self.tree.divide(self.targets) or end
        if first.kind is TransitionKind.LOCAL:
            return next(r for r in self.tree.region.regions_around(end) if r.owner == first.source)
        return self.tree.domain(self.source, end)

    @cached_property
    def left(self) -> str | None:
        """The outermost state that it leaves; None where it leaves none for sure."""
        if self.is_internal or self.path[0].kind is TransitionKind.LOCAL:
            return None
        child = self.tree.child(self.domain, self.source)
        return child if child in self.tree.states else None


def is_segment(transition: Transition) -> bool:
    """Whether it leaves a pseudostate."""
    return isinstance(transition.trigger, Segment)
