# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The most that one step of a region sends and raises.

For one occurrence a step takes at most one transition in each top-level or orthogonal region, each
with the choices and histories behind it. Guards are not looked into, and of the states that may
be active the worst counts: the bounds are safe, not exact.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from ravenchart.gen.language.terms import Flow, If, Raise, Send
from ravenchart.gen.model.statechart import (
    TOP,
    OnEvent,
    PseudoKind,
    Region,
    RegionId,
    Transition,
    When,
)
from ravenchart.gen.origins import Origin

from .tree import Tree, Way, is_segment

RAISED = ""
"""Stands for all events in a `Tally`: no port has this name."""

Tally = dict[str, tuple[Origin, ...]]
"""For each port, and for `RAISED`, the actions on the way that has most of them."""


def then(parts: Iterable[Tally]) -> Tally:
    """One after the other."""
    found: Tally = {}
    for part in parts:
        for name, origins in part.items():
            found[name] = (*found.get(name, ()), *origins)
    return found


def either(parts: Iterable[Tally]) -> Tally:
    """One of them: for each port the worst."""
    found: Tally = {}
    for part in parts:
        for name, origins in part.items():
            found[name] = max(found.get(name, ()), origins, key=len)
    return found


def tally(flow: Flow) -> Tally:
    """The sends and raises of a flow."""
    return then(_of_action(action) for action in flow)


def _of_action(action: object) -> Tally:
    match action:
        case Send(origin, port):
            return {port: (origin,)}
        case Raise(origin):
            return {RAISED: (origin,)}
        case If():
            return either((tally(action.then), tally(action.otherwise)))
    return {}


@dataclass(frozen=True)
class Steps:
    """The steps of one region, whose structure is sound."""

    tree: Tree

    @property
    def region(self) -> Region:
        """The region."""
        return self.tree.region

    # --- in and out

    def leaving(self, state: str) -> Tally:
        """Exits of a state and of whatever is active inside."""
        inside = [self.leaving_region(region) for region in self.tree.regions(state)]
        return then((*inside, tally(self.tree.states[state].exit)))

    def leaving_region(self, region: RegionId) -> Tally:
        """Exits of whatever is active in a region."""
        return either(self.leaving(state.name) for state in self.tree.content.get(region, ()))

    def entering(self, region: RegionId, targets: tuple[str, ...]) -> Tally:
        """Entries into a region on the way to targets, or by default."""
        return then(tally(entry.flow) for entry in self.tree.entries(region, targets))

    def restoring(self, region: RegionId) -> Tally:
        """Entries of whatever a history may restore in a region."""
        return either(
            then(
                (
                    tally(state.entry),
                    *(
                        either((self.restoring(inner), self.entering(inner, ())))
                        for inner in self.tree.regions(state.name)
                    ),
                )
            )
            for state in self.tree.content.get(region, ())
        )

    # --- transitions

    def start(self) -> Tally:
        """The first step."""
        return self.entering(TOP, ())

    def firing(self, transition: Transition) -> Tally:
        """A transition with everything that follows from it."""
        return either(self._way(way) for way in self.tree.ways(transition))

    def _way(self, way: Way) -> Tally:
        tree = self.tree
        effects = [tally(t.effect) for t in way.path]
        if way.is_internal:
            return then(effects)
        target = way.target
        kind = tree.kind(target)
        if kind is PseudoKind.JOIN:
            sources = [tally(t.effect) for t in tree.incoming[target] if t is not way.path[0]]
            onward = [self.firing(t) for t in tree.outgoing[target]]
            return then((*effects, *sources, *onward))
        if kind is PseudoKind.TERMINATE:
            return then(effects)
        if kind is PseudoKind.FORK:
            effects += [tally(t.effect) for t in tree.outgoing[target]]
        entered = self.entering(way.domain, way.targets)
        return then((self._exits(way), *effects, entered, self._onward(target)))

    def _exits(self, way: Way) -> Tally:
        """The worst of the exits on a way."""
        if way.left is None:
            is_local = way.domain.owner == way.path[0].source
            return self.leaving_region(way.domain) if is_local else {}
        source = way.source
        chain = (source, *self.tree.above(source))
        parts: list[Tally] = []
        below: str | None = None
        for state in chain[: chain.index(way.left) + 1]:
            if state not in self.tree.states:
                below = state
                continue
            beside = [
                r for r in self.tree.regions(state) if below is None or not self._in(r, below)
            ]
            parts += [self.leaving_region(region) for region in beside]
            parts.append(tally(self.tree.states[state].exit))
            below = state
        return then(parts)

    def _in(self, region: RegionId, vertex: str) -> bool:
        return self.tree.child(region, vertex) is not None

    def _onward(self, target: str) -> Tally:
        """The sends and raises behind a choice or history in the same step."""
        match self.tree.kind(target):
            case PseudoKind.CHOICE:
                return self._behind[target]
            case PseudoKind.HISTORY | PseudoKind.DEEP_HISTORY:
                region = self.tree.region.region_of(target)
                default = [self.entering(region, ())]
                for segment in self.tree.outgoing.get(target, ()):
                    effect = tally(segment.effect)
                    default = [then((effect, self.entering(region, (segment.target,))))]
                return either((self.restoring(region), *default))
        return {}

    @cached_property
    def _behind(self) -> _Behind:
        return _Behind(self)

    # --- steps

    def lost(self, transition: Transition) -> int:
        """How many orthogonal states around its source a transition leaves at least."""
        return min((self._lost(way) for way in self.tree.ways(transition)), default=0)

    def _lost(self, way: Way) -> int:
        if way.left is None:
            return 0
        above = self.tree.above(way.path[0].source)
        inside = above[: above.index(way.left) + 1] if way.left in above else ()
        return sum(self.tree.is_orthogonal(state) for state in inside)

    def together(self, transitions: Sequence[Transition]) -> Tally:
        """The worst step for one occurrence that enables these transitions."""
        by_region: dict[RegionId, list[Transition]] = {}
        for transition in transitions:
            around = self.region.concurrent_region(transition.source)
            by_region.setdefault(around, []).append(transition)
        return either(self._in_region(TOP, by_region).values())

    def _in_region(
        self, region: RegionId, by_region: dict[RegionId, list[Transition]]
    ) -> dict[int, Tally]:
        """The worst inside a region, by the number of orthogonal states around it that are left."""
        options: dict[int, list[Tally]] = {}
        for transition in by_region.get(region, ()):
            options.setdefault(self.lost(transition), []).append(self.firing(transition))
        for state in self._orthogonal[region]:
            inner = [self._in_region(nested, by_region) for nested in self.tree.regions(state)]
            options.setdefault(0, []).append(then(one.get(0, {}) for one in inner))
            for one in inner:
                for lost, worst in one.items():
                    if lost > 0:
                        options.setdefault(lost - 1, []).append(worst)
        return {lost: either(worst) for lost, worst in options.items()}

    @cached_property
    def _orthogonal(self) -> dict[RegionId, list[str]]:
        """The orthogonal states in each top-level or orthogonal region."""
        found: dict[RegionId, list[str]] = {TOP: []}
        for state in self.region.states:
            if state.is_orthogonal:
                found.setdefault(self.region.concurrent_region(state.name), []).append(state.name)
                for region in self.tree.regions(state.name):
                    found.setdefault(region, [])
        return found

    def single(self) -> Iterator[tuple[str, Tally]]:
        """The most that the start and each transition by itself send and raise."""
        region = self.region
        yield f"entering {region.name}", self.start()
        for transition in region.transitions:
            if not is_segment(transition):
                yield f"the transition {transition.name} of {region.name}", self.firing(transition)

    def shared(self) -> Iterator[tuple[str, Tally]]:
        """The most that steps with transitions in several orthogonal regions send and raise."""
        region = self.region
        if not any(state.is_orthogonal for state in region.states):
            return
        shared: dict[str, list[Transition]] = {}
        for transition in region.transitions:
            match transition.trigger:
                case OnEvent(event):
                    shared.setdefault(f"a step of {region.name} on {event}", []).append(transition)
                case When():
                    shared.setdefault(f"a step of {region.name} by `when`", []).append(transition)
        for what, transitions in shared.items():
            yield what, self.together(transitions)


class _Behind(dict[str, Tally]):
    """The sends and raises behind each choice, computed once."""

    def __init__(self, steps: Steps) -> None:
        super().__init__()
        self.steps = steps

    def __missing__(self, choice: str) -> Tally:
        segments = self.steps.tree.outgoing.get(choice, ())
        self[choice] = either(self.steps.firing(segment) for segment in segments)
        return self[choice]
