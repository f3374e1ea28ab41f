# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Compound transitions: the states that each way through the chart leaves and enters.

A `Firing` is one line of the declared chart. It is a transition of a state, together with the
junctions, forks and joins it passes; a segment that leaves a choice or a history; or a deferral.
Choices, histories and terminates are leaves that a step passes through (terminate: stays in).
UML 2.5.1, 14.2.3.8 and 14.2.3.9.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property, lru_cache

from ravenchart.gen.language.terms import Expression, Flow
from ravenchart.gen.model.chart.tree import Place
from ravenchart.gen.model.statechart import (
    Completion,
    Lane,
    PseudoKind,
    Pseudostate,
    Region,
    Segment,
    State,
    Transition,
    TransitionKind,
    Trigger,
)
from ravenchart.gen.origins import Origin

from .own_names import transition_literal

PASSED = (PseudoKind.CHOICE, PseudoKind.HISTORY, PseudoKind.DEEP_HISTORY)
"""Pseudostates that an execution passes through as a leaf."""


class FiringKind(Enum):
    """The kind of a line of the declared chart."""

    MOVE = "move"
    INTERNAL = "internal"
    DEFERRAL = "deferral"
    RESTORE = "restore"


TOP = Place(None, "")
"""The top-level region."""


@dataclass(frozen=True, slots=True)
class Effect:
    """Actions under the name that a trace gives them."""

    name: str
    flow: Flow


@dataclass(frozen=True, slots=True)
class Enter:
    """Entry of a state, or of a pseudostate that is passed through."""

    vertex: str


EntryStep = Effect | Enter


@dataclass(frozen=True, slots=True)
class Firing:
    """One line of the declared chart; see the module."""

    name: str
    kind: FiringKind
    lane: Lane
    sources: tuple[str, ...]
    triggers: tuple[Trigger | str, ...]
    """The occurrences that it is for; a string is an event that is deferred."""
    guards: tuple[Expression, ...]
    domain: Place | None
    """The innermost region that holds all it leaves and enters; None: it moves nothing."""
    effects: tuple[Effect, ...] = ()
    entries: tuple[EntryStep, ...] = ()
    goal: str | None = None
    """The pseudostate or state it leads to; None for a fork."""
    origins: tuple[Origin, ...] = ()
    """Where the transitions that it consists of stand, or the vertex that it comes from."""
    vertex: str | None = None
    """The state or pseudostate that it comes from, where the model has no transition for it."""

    @property
    def literal(self) -> str:
        """Its name in Ada, which is none that the region's package has for itself."""
        return transition_literal(self.name)


@lru_cache(maxsize=4096)
def compounds_of(region: Region) -> Compounds:
    """The lines of a region's declared chart; kept, for many emitters ask."""
    return Compounds(region)


class Compounds:
    """All lines of a region's chart, and the geometry they need; made by `compounds_of`."""

    def __init__(self, region: Region) -> None:
        self.region = region
        vertices: tuple[State | Pseudostate, ...] = (*region.states, *region.pseudostates)
        self._placed = {v.name.lower(): Place(v.parent, v.region) for v in vertices}

    # --- geometry

    def place(self, vertex: str) -> Place:
        """The region that a state or pseudostate stands in."""
        return self._placed[vertex.lower()]

    def places(self, vertex: str) -> list[Place]:
        """The regions around a vertex, innermost first."""
        found = [self.place(vertex)]
        while found[-1].owner is not None:
            found.append(self.place(found[-1].owner))
        return found

    def common(self, vertices: list[str]) -> Place:
        """The innermost region that holds all vertices."""
        first, *rest = (self.places(v) for v in vertices)
        return next(p for p in first if all(p in others for others in rest))

    def below(self, place: Place, vertex: str) -> list[str]:
        """``vertex`` and the states around it inside ``place``, outermost first."""
        path = [vertex]
        while self.place(path[-1]) != place:
            owner = self.place(path[-1]).owner
            assert owner is not None
            path.append(owner)
        return path[::-1]

    def passed(self, place: Place) -> tuple[str, ...]:
        """The pseudostates of a region that a step passes as leaves."""
        return tuple(
            p.name
            for p in self.region.pseudostates
            if (p.kind in PASSED and self.place(p.name) == place)
            or (p.kind is PseudoKind.TERMINATE and place == TOP)
        )

    # --- entries

    def default(self, place: Place) -> tuple[EntryStep, ...]:
        """Default entry of a region: its initial effect, then its initial state."""
        if place.owner is None:
            label, initial = self.region.name, self.region.initial
        else:
            label = place.region or place.owner
            initial = self.region.state(place.owner).nested(place.region).initial
        effect = (Effect(f"initial({label})", initial.effect),) if initial.effect else ()
        return (*effect, *self.into(place, [initial.target]))

    def into(
        self, place: Place, targets: list[str], effects: dict[str, Effect] | None = None
    ) -> tuple[EntryStep, ...]:
        """Entry from ``place`` down to ``targets``; each one's effect runs before its region."""
        top = self.below(place, targets[0])[0]
        if self.region.pseudostate(top) is not None:
            return (Enter(top),)
        inner = [t for t in targets if t != top]
        regions = (Place(top, r.name) for r in self.region.state(top).regions)
        nested = [self._nested(r, inner, effects or {}) for r in regions]
        return (Enter(top), *(step for steps in nested for step in steps))

    def _nested(
        self, place: Place, targets: list[str], effects: dict[str, Effect]
    ) -> tuple[EntryStep, ...]:
        here = [t for t in targets if place in self.places(t)]
        if not here:
            return self.default(place)
        if len(here) > 1:
            return self.into(place, here, effects)
        before = (effects[here[0]],) if here[0] in effects else ()
        return (*before, *self.into(place, here))

    # --- the lines of the declared chart

    @cached_property
    def firings(self) -> tuple[Firing, ...]:
        """All lines of the chart by region, inner ones first, in each in order of precedence."""
        found: list[Firing] = []
        for lane in self.region.lanes():
            lines = self._lines(lane)
            lines.sort(key=lambda f: -max(len(self.region.ancestors(s)) for s in f.sources))
            found += lines
        return tuple(found)

    def _lines(self, lane: Lane) -> list[Firing]:
        lines: list[Firing] = []
        for transition in self.region.transitions:
            if isinstance(transition.trigger, Segment):
                continue
            if self.region.lane(transition.source) == lane:
                lines += self._paths((transition,), lane)
        for state in self.region.states:
            if self.region.lane(state.name) == lane:
                lines += [
                    Firing(
                        f"Defer_{e}_In_{state.name}",
                        FiringKind.DEFERRAL,
                        lane,
                        (state.name,),
                        (e,),
                        (),
                        None,
                        origins=(state.origin,),
                        vertex=state.name,
                    )
                    for e in state.defers
                ]
        for pseudo in self.region.pseudostates:
            if self.region.lane(pseudo.name) == lane and pseudo.kind in PASSED:
                lines += self._passing(pseudo, lane)
        return lines

    def _passing(self, pseudo: Pseudostate, lane: Lane) -> list[Firing]:
        name, kind = pseudo.name, pseudo.kind
        lines: list[Firing] = []
        if kind is not PseudoKind.CHOICE:
            lines.append(
                Firing(
                    f"Restore_{name}",
                    FiringKind.RESTORE,
                    lane,
                    (name,),
                    (Segment(),),
                    (),
                    self.place(name),
                    goal=name,
                    origins=(pseudo.origin,),
                    vertex=name,
                )
            )
        out = self.region.outgoing(name)
        for segment in out:
            lines += self._paths((segment,), lane)
        if kind is not PseudoKind.CHOICE and not out:
            place = self.place(name)
            entries = self.default(place)
            lines.append(
                Firing(
                    f"Default_Of_{name}",
                    FiringKind.MOVE,
                    lane,
                    (name,),
                    (Segment(),),
                    (),
                    place,
                    (),
                    entries,
                    origins=(pseudo.origin,),
                    vertex=name,
                )
            )
        return lines

    def _paths(self, so_far: tuple[Transition, ...], lane: Lane) -> list[Firing]:
        last = so_far[-1]
        pseudo = self.region.pseudostate(last.target)
        if pseudo is not None and pseudo.kind is PseudoKind.JUNCTION:
            ways = self.region.outgoing(pseudo.name)
            return [f for way in ways for f in self._paths((*so_far, way), lane)]
        if pseudo is not None and pseudo.kind is PseudoKind.JOIN:
            return self._joined(so_far, pseudo.name, lane)
        return [self._firing(so_far, (so_far[0],), lane)]

    def _joined(self, so_far: tuple[Transition, ...], join: str, lane: Lane) -> list[Firing]:
        incoming = tuple(t for t in self.region.transitions if t.target == join)
        if so_far[0] != incoming[0]:
            return []
        (out,) = self.region.outgoing(join)
        return [self._firing((*incoming, *path), incoming, lane) for path in self._beyond((out,))]

    def _beyond(self, so_far: tuple[Transition, ...]) -> list[tuple[Transition, ...]]:
        """The ways on from a segment through junctions."""
        pseudo = self.region.pseudostate(so_far[-1].target)
        if pseudo is None or pseudo.kind is not PseudoKind.JUNCTION:
            return [so_far]
        ways = self.region.outgoing(pseudo.name)
        return [p for way in ways for p in self._beyond((*so_far, way))]

    def _firing(
        self, path: tuple[Transition, ...], first: tuple[Transition, ...], lane: Lane
    ) -> Firing:
        main, last = path[0], path[-1]
        named = [main, *(t for t in path[1:] if t not in first)]
        name = "_Then_".join(t.name for t in named)
        sources = tuple(t.source for t in first)
        triggers: tuple[Trigger, ...] = tuple(dict.fromkeys(t.trigger for t in first))
        if len(first) > 1:
            triggers = (Completion(),)
        guards = tuple(t.guard for t in path if t.guard is not None)
        effects = tuple(Effect(t.name, t.effect) for t in path)
        origins = tuple(t.origin for t in path)
        if main.kind is TransitionKind.INTERNAL:
            return Firing(
                name,
                FiringKind.INTERNAL,
                lane,
                sources,
                triggers,
                guards,
                None,
                effects,
                origins=origins,
            )
        targets: list[str] = [last.target]
        before: dict[str, Effect] = {}
        pseudo = self.region.pseudostate(last.target)
        goal: str | None = last.target
        if pseudo is not None and pseudo.kind is PseudoKind.FORK:
            prongs = self.region.outgoing(pseudo.name)
            targets = [t.target for t in prongs]
            before = {t.target: Effect(t.name, t.effect) for t in prongs}
            goal = None
            origins += tuple(t.origin for t in prongs)
        domain = self._domain(main, sources, targets)
        return Firing(
            name,
            FiringKind.MOVE,
            lane,
            sources,
            triggers,
            guards,
            domain,
            effects,
            self.into(domain, targets, before),
            goal,
            origins,
        )

    def _domain(self, main: Transition, sources: tuple[str, ...], targets: list[str]) -> Place:
        if main.kind is TransitionKind.LOCAL:
            return next(p for p in self.places(targets[0]) if p.owner == main.source)
        return self.common([*sources, *targets])

    # --- conflicts

    def left(self, firing: Firing) -> tuple[str, ...]:
        """The orthogonal states that a line leaves from inside, innermost first."""
        if firing.domain is None:
            return ()
        around = self.places(firing.sources[0])
        if firing.domain not in around:
            return ()
        owners = [p.owner for p in around[: around.index(firing.domain)]]
        return tuple(o for o in owners if o is not None and self.region.state(o).is_orthogonal)
