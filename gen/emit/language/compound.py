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
from ravenchart.gen.model.statechart import (
    TOP,
    Completion,
    PseudoKind,
    Pseudostate,
    Region,
    RegionId,
    Segment,
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
    region: RegionId
    sources: tuple[str, ...]
    triggers: tuple[Trigger | str, ...]
    """The occurrences that it is for; a string is an event that is deferred."""
    guards: tuple[Expression, ...]
    domain: RegionId | None
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

    # --- geometry

    def common(self, vertices: list[str]) -> RegionId:
        """The innermost region that holds all vertices."""
        first, *rest = (self.region.regions_around(v) for v in vertices)
        return next(r for r in first if all(r in others for others in rest))

    def below(self, region: RegionId, vertex: str) -> list[str]:
        """``vertex`` and the states around it inside ``region``, outermost first."""
        path = [vertex]
        while self.region.region_of(path[-1]) != region:
            owner = self.region.region_of(path[-1]).owner
            assert owner is not None
            path.append(owner)
        return path[::-1]

    def passed(self, region: RegionId) -> tuple[str, ...]:
        """The pseudostates of a region that a step passes as leaves."""
        return tuple(
            p.name
            for p in self.region.pseudostates
            if (p.kind in PASSED and self.region.region_of(p.name) == region)
            or (p.kind is PseudoKind.TERMINATE and region == TOP)
        )

    # --- entries

    def default(self, region: RegionId) -> tuple[EntryStep, ...]:
        """Default entry of a region: its initial effect, then its initial state."""
        if region.owner is None:
            label, initial = self.region.name, self.region.initial
        else:
            label = region.label
            initial = self.region.state(region.owner).nested(region.name).initial
        effect = (Effect(f"initial({label})", initial.effect),) if initial.effect else ()
        return (*effect, *self.into(region, [initial.target]))

    def into(
        self, region: RegionId, targets: list[str], effects: dict[str, Effect] | None = None
    ) -> tuple[EntryStep, ...]:
        """Entry from ``region`` down to ``targets``; each one's effect runs before its region."""
        top = self.below(region, targets[0])[0]
        if self.region.pseudostate(top) is not None:
            return (Enter(top),)
        inner = [t for t in targets if t != top]
        regions = self.region.state(top).region_ids
        nested = [self._nested(r, inner, effects or {}) for r in regions]
        return (Enter(top), *(step for steps in nested for step in steps))

    def _nested(
        self, region: RegionId, targets: list[str], effects: dict[str, Effect]
    ) -> tuple[EntryStep, ...]:
        here = [t for t in targets if region in self.region.regions_around(t)]
        if not here:
            return self.default(region)
        if len(here) > 1:
            return self.into(region, here, effects)
        before = (effects[here[0]],) if here[0] in effects else ()
        return (*before, *self.into(region, here))

    # --- the lines of the declared chart

    @cached_property
    def firings(self) -> tuple[Firing, ...]:
        """All lines of the chart by region, inner ones first, in each in order of precedence."""
        found: list[Firing] = []
        for region in self.region.concurrent_regions():
            lines = self._lines(region)
            lines.sort(key=lambda f: -max(len(self.region.ancestors(s)) for s in f.sources))
            found += lines
        return tuple(found)

    def _lines(self, region: RegionId) -> list[Firing]:
        lines: list[Firing] = []
        for transition in self.region.transitions:
            if isinstance(transition.trigger, Segment):
                continue
            if self.region.concurrent_region(transition.source) == region:
                lines += self._paths((transition,), region)
        for state in self.region.states:
            if self.region.concurrent_region(state.name) == region:
                lines += [
                    Firing(
                        f"Defer_{e}_In_{state.name}",
                        FiringKind.DEFERRAL,
                        region,
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
            if self.region.concurrent_region(pseudo.name) == region and pseudo.kind in PASSED:
                lines += self._passing(pseudo, region)
        return lines

    def _passing(self, pseudo: Pseudostate, region: RegionId) -> list[Firing]:
        name, kind = pseudo.name, pseudo.kind
        lines: list[Firing] = []
        if kind is not PseudoKind.CHOICE:
            lines.append(
                Firing(
                    f"Restore_{name}",
                    FiringKind.RESTORE,
                    region,
                    (name,),
                    (Segment(),),
                    (),
                    self.region.region_of(name),
                    goal=name,
                    origins=(pseudo.origin,),
                    vertex=name,
                )
            )
        out = self.region.outgoing(name)
        for segment in out:
            lines += self._paths((segment,), region)
        if kind is not PseudoKind.CHOICE and not out:
            domain = self.region.region_of(name)
            entries = self.default(domain)
            lines.append(
                Firing(
                    f"Default_Of_{name}",
                    FiringKind.MOVE,
                    region,
                    (name,),
                    (Segment(),),
                    (),
                    domain,
                    (),
                    entries,
                    origins=(pseudo.origin,),
                    vertex=name,
                )
            )
        return lines

    def _paths(self, so_far: tuple[Transition, ...], region: RegionId) -> list[Firing]:
        last = so_far[-1]
        pseudo = self.region.pseudostate(last.target)
        if pseudo is not None and pseudo.kind is PseudoKind.JUNCTION:
            ways = self.region.outgoing(pseudo.name)
            return [f for way in ways for f in self._paths((*so_far, way), region)]
        if pseudo is not None and pseudo.kind is PseudoKind.JOIN:
            return self._joined(so_far, pseudo.name, region)
        return [self._firing(so_far, (so_far[0],), region)]

    def _joined(self, so_far: tuple[Transition, ...], join: str, region: RegionId) -> list[Firing]:
        incoming = tuple(t for t in self.region.transitions if t.target == join)
        if so_far[0] != incoming[0]:
            return []
        (out,) = self.region.outgoing(join)
        return [self._firing((*incoming, *path), incoming, region) for path in self._beyond((out,))]

    def _beyond(self, so_far: tuple[Transition, ...]) -> list[tuple[Transition, ...]]:
        """The ways on from a segment through junctions."""
        pseudo = self.region.pseudostate(so_far[-1].target)
        if pseudo is None or pseudo.kind is not PseudoKind.JUNCTION:
            return [so_far]
        ways = self.region.outgoing(pseudo.name)
        return [p for way in ways for p in self._beyond((*so_far, way))]

    def _firing(
        self, path: tuple[Transition, ...], first: tuple[Transition, ...], region: RegionId
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
                region,
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
            region,
            sources,
            triggers,
            guards,
            domain,
            effects,
            self.into(domain, targets, before),
            goal,
            origins,
        )

    def _domain(self, main: Transition, sources: tuple[str, ...], targets: list[str]) -> RegionId:
        if main.kind is TransitionKind.LOCAL:
            return next(r for r in self.region.regions_around(targets[0]) if r.owner == main.source)
        return self.common([*sources, *targets])

    # --- conflicts

    def left(self, firing: Firing) -> tuple[str, ...]:
        """The orthogonal states that a line leaves from inside, innermost first."""
        if firing.domain is None:
            return ()
        around = self.region.regions_around(firing.sources[0])
        if firing.domain not in around:
            return ()
        owners = [r.owner for r in around[: around.index(firing.domain)]]
        return tuple(o for o in owners if o is not None and self.region.state(o).is_orthogonal)
