# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Which states of a chart can be entered at all, and from where which can follow.

Guards are not looked into, and the regions of an orthogonal state are not related. So a state
found unreachable is, and one found reachable may not be.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from ravenchart.gen.model.statechart import (
    TOP,
    Completion,
    PseudoKind,
    RegionId,
    Transition,
    TransitionKind,
)

from .tree import Tree, Way

CanComplete = Callable[[str], bool]
"""Whether the do activities of a state, when it has any, can end."""


@dataclass
class Reach:
    """The states and pseudostates of a sound region that are reached."""

    tree: Tree
    ends: CanComplete
    found: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        """Follow everything until nothing is new."""
        self.found |= self._entered(TOP, ())
        left = list(self.tree.region.transitions)
        while True:
            size = len(self.found)
            for transition in tuple(left):
                if self.fires(transition):
                    self.found |= self.after(transition)
                    if not self._depends(transition):
                        left.remove(transition)
            if len(self.found) == size:
                return

    def _depends(self, transition: Transition) -> bool:
        """Whether where it leads depends on what is reached."""
        known = (PseudoKind.JOIN, PseudoKind.HISTORY, PseudoKind.DEEP_HISTORY)
        return any(self.tree.kind(way.target) in known for way in self.tree.ways(transition))

    def fires(self, transition: Transition) -> bool:
        """Whether a transition can be taken as far as its source is concerned."""
        if transition.source not in self.found:
            return False
        if not isinstance(transition.trigger, Completion):
            return True
        return self.completes(transition.source)

    def completes(self, state: str) -> bool:
        """Whether a state can complete: all its regions can end, and its do activities."""
        regions = self.tree.regions(state)
        return self.ends(state) and all(self.has_final(region) for region in regions)

    def has_final(self, region: RegionId) -> bool:
        """Whether a final state directly in a region is reached."""
        inside = self.tree.content.get(region, ())
        return any(state.final and state.name in self.found for state in inside)

    def after(self, transition: Transition) -> set[str]:
        """The vertices that are reached by a transition, up to the next pseudostate."""
        if transition.kind is TransitionKind.INTERNAL:
            return set()
        if self.tree.kind(transition.source) in (PseudoKind.JUNCTION, PseudoKind.FORK):
            return set()  # part of the transitions that lead there
        found: set[str] = set()
        for way in self.tree.ways(transition):
            found |= {t.target for t in way.path[:-1]} | self._by(way)
        return found

    def _by(self, way: Way) -> set[str]:
        """The vertices that one way enters."""
        kind = self.tree.kind(way.target)
        if kind is PseudoKind.JOIN:
            sources = {t.source for t in self.tree.incoming[way.target]}
            together = sources <= self.found and all(map(self.completes, sources))
            return {way.target} if together else set()
        if kind is PseudoKind.TERMINATE:
            return {way.target}
        entered = self._entered(way.domain, way.targets) | {way.target}
        if kind in (PseudoKind.HISTORY, PseudoKind.DEEP_HISTORY):
            entered |= self._restored(way.target)
        return entered

    def _entered(self, region: RegionId, targets: tuple[str, ...]) -> set[str]:
        entries = self.tree.entries(region, targets)
        states = {entry.state for entry in entries if entry.state is not None}
        return states | {target for target in targets if target in self.tree.states}

    def _restored(self, history: str) -> set[str]:
        """The states that a history may enter, beside its default transition."""
        region = self.tree.region.region_of(history)
        found: set[str] = set()
        if not self.tree.outgoing.get(history):
            found |= self._entered(region, ())
        below = [s for s in self.tree.states if s in self.found and self.tree.child(region, s)]
        if self.tree.kind(history) is PseudoKind.HISTORY:
            for state in below:
                if self.tree.region.region_of(state) == region:
                    found |= self._entered(region, (state,))
            return found
        for state in below:
            found.add(state)
            for inner in self.tree.regions(state):
                if self.has_final(inner):
                    found |= self._entered(inner, ())
        return found

    # --- from where to where

    @cached_property
    def before(self) -> Mapping[str, set[str]]:
        """The vertices that can be active, or passed, where a vertex follows.

        A state that stays active beside one that moves can be followed by the other's targets.
        """
        before: defaultdict[str, set[str]] = defaultdict(set)
        for transition in self.tree.region.transitions:
            if self.fires(transition):
                for target in self.after(transition):
                    before[target].add(transition.source)
        for state in self.tree.states:
            if state not in self.found:
                continue
            for outer in self.tree.above(state):
                for other in (outer, *self._beside(outer, state)):
                    before[other].add(state)
        return before

    def _beside(self, outer: str, state: str) -> Iterator[str]:
        """The states that may be active in the other regions of an orthogonal state."""
        for region in self.tree.regions(outer):
            if self.tree.child(region, state) is None:
                yield from (s.name for s in self.tree.content[region] if s.name in self.found)

    def leading_to(self, state: str) -> set[str]:
        """The vertices from which some way leads to a state, or that are in it."""
        leading = {s for s in self.found if s == state or state in self.tree.above(s)}
        new = list(leading)
        while new:
            found = self.before.get(new.pop(), set()) - leading
            leading |= found
            new += found
        return leading
