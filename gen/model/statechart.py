# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Statecharts as the model holds them: vertices, transitions and their tree.

A top-level region is a tree: a composite state has one nested region, an orthogonal one
several. Leaf states and pseudostates are its leaves. The concurrent regions are the top-level
one and those of orthogonal states. Each reaches as far as no other begins inside it. While a
concurrent region is active, exactly one of its leaves is; an orthogonal state is a leaf of the
one that it stands in. Terms are those of UML 2.5.1, clause 14.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import NamedTuple

from ravenchart.gen.language.terms import Expression, Flow, Ns, named
from ravenchart.gen.origins import Origin

DONE = "done"
"""The event that a do activity raises to complete its state."""


RAISED_PER_STEP = 16
"""Events that one step of a region raises at most."""


class RegionId(NamedTuple):
    """A region inside a chart, by the state that it belongs to and its own name."""

    owner: str | None
    name: str

    @property
    def label(self) -> str:
        """Its name, or that of its state where it has none."""
        return self.name or self.owner or ""


TOP = RegionId(None, "")
"""The top-level region of any chart."""


class Overflow(Enum):
    """The rule of a full queue for one element more; either way the loss is counted."""

    REJECT_NEWEST = "reject_newest"
    DROP_OLDEST = "drop_oldest"


@dataclass(frozen=True, slots=True)
class Timing:
    """Period, worst-case execution time and relative deadline of an activity."""

    period: Ns
    wcet: Ns
    deadline: Ns


@dataclass(frozen=True, slots=True)
class Initial:
    """Default entry of a region: the state it leads to, at any depth, and its effect."""

    target: str
    effect: Flow = ()


@dataclass(frozen=True, slots=True)
class NestedRegion:
    """A region of a composite state. The only region of one may have no name (``""``)."""

    name: str
    origin: Origin
    initial: Initial


@dataclass(frozen=True, slots=True)
class State:
    """A state; ``region`` says in which region of ``parent`` it stands.

    A final state has neither regions nor behaviours. ``defers`` names events.
    """

    name: str
    origin: Origin
    parent: str | None
    region: str
    regions: tuple[NestedRegion, ...]
    entry: Flow
    exit: Flow
    defers: tuple[str, ...] = ()
    final: bool = False

    @property
    def is_leaf(self) -> bool:
        """No substates."""
        return not self.regions

    @property
    def is_orthogonal(self) -> bool:
        """More regions than one."""
        return len(self.regions) > 1

    @property
    def region_ids(self) -> tuple[RegionId, ...]:
        """The identities of its regions, in model order."""
        return tuple(RegionId(self.name, region.name) for region in self.regions)

    def nested(self, region: str) -> NestedRegion:
        """Its region called ``region``; KeyError where there is none."""
        return named(self.regions, region)


class PseudoKind(Enum):
    """The kind of a pseudostate, with its effect on a transition that reaches it."""

    CHOICE = "choice"
    JUNCTION = "junction"
    HISTORY = "history"
    DEEP_HISTORY = "deep_history"
    FORK = "fork"
    JOIN = "join"
    TERMINATE = "terminate"


@dataclass(frozen=True, slots=True)
class Pseudostate:
    """A vertex that no execution rests in (terminate excepted)."""

    name: str
    origin: Origin
    kind: PseudoKind
    parent: str | None
    region: str


class TransitionKind(Enum):
    """External leaves its source, local only what lies inside it, internal nothing."""

    EXTERNAL = "external"
    LOCAL = "local"
    INTERNAL = "internal"


@dataclass(frozen=True, slots=True)
class OnEvent:
    """Triggered by an event from the region's queue."""

    event: str


@dataclass(frozen=True, slots=True)
class After:
    """Triggered this long after the source was entered, in whole executions."""

    delay: Ns
    executions: int


@dataclass(frozen=True, slots=True)
class Every:
    """Like `After`, again and again while the source is active."""

    delay: Ns
    executions: int


@dataclass(frozen=True, slots=True)
class When:
    """Triggered by a condition, read when no other occurrence waits."""

    condition: Expression


@dataclass(frozen=True, slots=True)
class Completion:
    """Triggered by the completion of its source, a state."""


@dataclass(frozen=True, slots=True)
class Segment:
    """Leaves a pseudostate: part of the compound transition that reached it."""


Trigger = OnEvent | After | Every | When | Completion | Segment


@dataclass(frozen=True, slots=True)
class Transition:
    """One transition or segment; internal ones have their source as target.

    ``otherwise``: its guard is ``else``, and ``guard`` is None.
    """

    name: str
    origin: Origin
    source: str
    target: str
    kind: TransitionKind
    trigger: Trigger
    guard: Expression | None
    effect: Flow
    otherwise: bool = False


@dataclass(frozen=True)
class Region:
    """A top-level region. ``states`` stand in tree order: parent first, then its children.

    Names of states, pseudostates and nested regions are unique in it, without
    regard to case. ``reads`` and ``writes`` are derived from its guards and flows.
    """

    name: str
    origin: Origin
    timing: Timing
    queue_depth: int
    overflow: Overflow
    on_overflow: str | None
    steps_per_execution: int
    initial: Initial
    safe_state: str | None
    states: tuple[State, ...]
    transitions: tuple[Transition, ...]
    reads: tuple[str, ...]
    writes: tuple[str, ...]
    sends: tuple[str, ...]
    raises: tuple[str, ...]
    pseudostates: tuple[Pseudostate, ...] = ()
    deferral_depth: int = 0
    """Deferred events that wait at most; one more is lost and counted."""

    def __hash__(self) -> int:
        """Quick: name and location tell a region apart from most others."""
        return hash((self.name, self.origin))

    # --- vertices

    @cached_property
    def _states(self) -> dict[str, State]:
        return {s.name.lower(): s for s in self.states}

    @cached_property
    def _pseudostates(self) -> dict[str, Pseudostate]:
        return {p.name: p for p in self.pseudostates}

    def state(self, name: str) -> State:
        """The state called ``name``; KeyError where there is none."""
        return self._states[name.lower()]

    def pseudostate(self, name: str) -> Pseudostate | None:
        """The pseudostate called ``name``; None where there is none."""
        return self._pseudostates.get(name)

    def parent(self, name: str) -> str | None:
        """The state around a state or pseudostate; None at the top."""
        pseudo = self.pseudostate(name)
        return self.state(name).parent if pseudo is None else pseudo.parent

    def region_of(self, vertex: str) -> RegionId:
        """The region that a state or pseudostate stands in."""
        found = self.pseudostate(vertex) or self.state(vertex)
        return RegionId(found.parent, found.region)

    def regions_around(self, vertex: str) -> tuple[RegionId, ...]:
        """The regions around a vertex, innermost first; the last is the top-level region."""
        found = [self.region_of(vertex)]
        while found[-1].owner is not None:
            found.append(self.region_of(found[-1].owner))
        return tuple(found)

    def children(self, name: str | None, region: str | None = None) -> tuple[State, ...]:
        """The direct substates of ``name`` (None: the top states), of one of its regions or all."""
        inside = (s for s in self.states if s.parent == name)
        return tuple(s for s in inside if region is None or s.region == region)

    def ancestors(self, name: str) -> tuple[str, ...]:
        """A state or pseudostate and its enclosing states, innermost first."""
        chain: list[str] = []
        at: str | None = name
        while at is not None:
            chain.append(at)
            at = self.parent(at)
        return tuple(chain)

    def leaves(self, name: str | None = None) -> tuple[str, ...]:
        """The states without substates inside ``name`` (itself, when one), in tree order."""
        return tuple(
            s.name
            for s in self.states
            if s.is_leaf and (name is None or name in self.ancestors(s.name))
        )

    def default_leaf(self, name: str) -> str:
        """The leaf that default entry of ``name`` leads to; an orthogonal state is one itself."""
        regions = self.state(name).regions
        return name if len(regions) != 1 else self.default_of(RegionId(name, regions[0].name))

    def default_of(self, region: RegionId) -> str:
        """The leaf that default entry of a region leads to.

        An orthogonal state on the way to the initial target is that leaf.
        """
        owner = region.owner
        initial = self.initial if owner is None else self.state(owner).nested(region.name).initial
        chain = self.ancestors(initial.target)
        entered = chain if owner is None else chain[: chain.index(owner)]
        stop = next((name for name in reversed(entered) if self.state(name).is_orthogonal), None)
        return stop or self.default_leaf(initial.target)

    # --- concurrent regions

    def concurrent_regions(self) -> tuple[RegionId, ...]:
        """The orthogonal regions in model order, inner before outer; last the top-level region."""
        found: list[RegionId] = []

        def inside(region: RegionId) -> None:
            for state in self.children(*region):
                for nested in state.region_ids:
                    inside(nested)
                    if state.is_orthogonal:
                        found.append(nested)

        inside(TOP)
        return (*found, TOP)

    def concurrent_region(self, vertex: str) -> RegionId:
        """The innermost top-level or orthogonal region around a state or pseudostate."""
        return self._concurrent[vertex.lower()]

    @cached_property
    def _concurrent(self) -> dict[str, RegionId]:
        names = [*(s.name for s in self.states), *(p.name for p in self.pseudostates)]
        return {name.lower(): self._concurrent_around(name) for name in names}

    def _concurrent_around(self, vertex: str) -> RegionId:
        at: str | None = vertex
        while at is not None:
            pseudo = self.pseudostate(at)
            parent = self.parent(at)
            region = self.state(at).region if pseudo is None else pseudo.region
            if parent is not None and self.state(parent).is_orthogonal:
                return RegionId(parent, region)
            at = parent
        return TOP

    # --- transitions and events

    def outgoing(self, name: str) -> tuple[Transition, ...]:
        """The transitions that leave a vertex, in model order, ``else`` last."""
        leaving = (t for t in self.transitions if t.source == name)
        return tuple(sorted(leaving, key=lambda t: t.otherwise))

    def precedence(self) -> tuple[Transition, ...]:
        """The transitions of states, innermost source first, then in model order."""
        triggered = (t for t in self.transitions if not isinstance(t.trigger, Segment))
        return tuple(sorted(triggered, key=lambda t: -len(self.ancestors(t.source))))

    @property
    def takes_turns(self) -> bool:
        """Whether what it answers to may wait: it takes one occurrence after the other.

        Conditions do not wait for each other; they are read where nothing else does.
        """
        kinds = (OnEvent, After, Every, Completion)
        return bool(self.events()) or any(isinstance(t.trigger, kinds) for t in self.transitions)

    def events(self) -> tuple[str, ...]:
        """The events that the region names in triggers or defers, each once, in model order."""
        named = [t.trigger.event for t in self.transitions if isinstance(t.trigger, OnEvent)]
        named += [event for s in self.states for event in s.defers]
        return tuple(dict.fromkeys(named))
