# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One step of a region, with data as terms: its outcomes, and their conditions.

An `OpenStep` follows docs/semantics.md as an interpreter does. Where it has to know
whether a condition holds, it asks. `outcomes` runs it once for each series of
answers that some data allow.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

import z3

from ravenchart.behaviour.tree import TOP, ChartTree, Occurrence, RegionKey
from ravenchart.gen.language.terms import Expression, Flow, If, Raise, Reading, Set
from ravenchart.gen.model.statechart import PseudoKind, Transition, TransitionKind, When

from .logic import Questions, Term, Variable, term, variable


@dataclass(frozen=True, slots=True)
class Configuration:
    """The control of a region; all but ``history`` in tree order."""

    active: tuple[str, ...] = ()
    completed: tuple[str, ...] = ()
    """Active states whose completion has come."""
    pending: tuple[str, ...] = ()
    """Those whose completion has not had its step."""
    done: tuple[str, ...] = ()
    """Active states whose do activity is done."""
    history: tuple[tuple[RegionKey, str], ...] = ()
    stopped: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Rival:
    """A transition that was not tried, because one with the same trigger came before it."""

    first: str
    second: str
    condition: Term
    """Under which the second could have been taken as well."""


@dataclass(frozen=True, slots=True)
class DeferredStep:
    """A state keeps the event for later."""

    state: str


TransitionPath = tuple[Transition, ...]
"""A compound transition: through junctions, to a vertex that is none."""


class StuckStep(Exception):  # noqa: N818
    """A pseudostate that no enabled segment leaves."""


class Defeat(Enum):
    """Why a transition that was selected has not been taken."""

    DEFERRAL = 1
    """A state of another region defers the event."""
    CONFLICT = 2
    """A transition taken before leaves the source of this one."""
    END = 3
    """A transition taken before ends the region."""


@dataclass(frozen=True, slots=True)
class Beaten:
    """A transition that was selected and not taken, for a transition or a deferring state."""

    transition: str
    by: str
    why: Defeat


@dataclass
class OpenStep:
    """One step that is being made."""

    tree: ChartTree
    before: Configuration
    occurrence: Occurrence
    questions: Questions
    decide: Callable[[Term], bool]
    recall: Callable[[RegionKey], str | None] = lambda slot: None
    """The leaf that a region remembers, unless this step or the configuration before has it."""
    contested: Mapping[Variable, Term] | None = None
    """Where ``before`` is a part of a configuration (`parts`): the data that other active regions
    may set, each with the unknown for it once the step has selected."""
    active: set[str] = field(init=False)
    history: dict[RegionKey, str | None] = field(init=False)
    store: dict[Variable, Term] = field(default_factory=dict)
    raised: list[tuple[str, tuple[tuple[str | None, Term], ...]]] = field(default_factory=list)
    fired: list[str] = field(default_factory=list)
    entered: set[str] = field(default_factory=set)
    left: set[str] = field(default_factory=set)
    arrivals: list[str] = field(default_factory=list)
    rivals: list[Rival] = field(default_factory=list)
    beaten: list[Beaten] = field(default_factory=list)
    stopped: bool = False
    deferred: bool = False
    firing: bool = False
    noted: list[Any] = field(default_factory=list)
    """The notes of a watched step."""

    def __post_init__(self) -> None:
        self.active = set(self.before.active)
        self.history = dict(self.before.history)

    def run(self) -> str | None:
        """Make the step; the pseudostate where it gets stuck, if any."""
        try:
            if self.occurrence.kind == "start":
                self.initial(TOP)
                self.settle()
            elif self.occurrence.kind != "done":
                self.fire_all(self.select())
        except StuckStep as found:
            return str(found)
        return None

    # --- data

    def read(self, name: Variable) -> Term:
        """The value that a variable has now; an own state was active before the step, or not."""
        own = name[:2] == ("in", self.tree.region.name)
        if own and self.tree.determines(self.before.active, name.state):
            return z3.BoolVal(name.state in self.before.active)
        if self.firing and self.contested and name in self.contested:
            return self.contested[name]
        return self.store[name] if name in self.store else self.questions.read(name)

    def value(self, expression: Expression) -> Term:
        """The value of an expression now."""
        if self.tree.asks_own or self.store or (self.firing and self.contested):
            return term(expression, self.read)
        return self.questions.term(expression)

    def holds(self, expression: Expression | None) -> bool:
        """Whether a condition holds now; a missing condition holds."""
        return expression is None or self.decide(self.value(expression))

    def perform(self, flow: Flow) -> None:
        """Run a flow."""
        for action in flow:
            match action:
                case Set(_, data, member, value):
                    self.store[variable(Reading.DATA, data, member)] = self.value(value)
                case Raise(_, event, values):
                    carried = tuple((f, self.value(value)) for f, value in values)
                    self.raised.append((event, carried))
                case If() if raises(action):
                    self.perform(action.then if self.holds(action.condition) else action.otherwise)
                case If():
                    self.merge(action)

    def merge(self, action: If) -> None:
        """Run both branches; each variable gets the value of the branch that is taken."""
        condition = self.value(action.condition)
        before = self.store
        self.store = dict(before)
        self.perform(action.then)
        then, self.store = self.store, dict(before)
        self.perform(action.otherwise)
        otherwise, self.store = self.store, dict(before)
        for name in {**then, **otherwise}:
            values = (side.get(name, self.read(name)) for side in (then, otherwise))
            self.store[name] = z3.simplify(z3.If(condition, *values))

    # --- selection

    def select(self) -> list[TransitionPath]:
        """The selection of each region, in model order; nothing when the event is deferred."""
        chosen: list[TransitionPath] = []
        deferring: list[str] = []
        busy: set[str] = set()
        chains: dict[RegionKey, list[str]] = {}
        for name in reversed(self.tree.ordered(self.active)):
            chains.setdefault(self.tree.concurrent_region_of[name], []).append(name)
        for region in self.tree.concurrent_regions:
            chain = chains.get(region, [])
            if any(name in busy for name in chain):
                continue
            found = self.select_in(chain)
            if isinstance(found, DeferredStep):
                self.deferred = True
                deferring.append(found.state)
            elif found is not None:
                chosen.append(found)
            if found is not None and region.owner is not None:
                busy |= set(self.tree.chains[region.owner])
        self.beaten += [
            Beaten(p[0].name, state, Defeat.DEFERRAL) for p in chosen for state in deferring
        ]
        return [] if self.deferred else chosen

    def select_in(self, chain: Sequence[str]) -> TransitionPath | DeferredStep | None:
        """The first enabled transition of the states of a region, innermost first."""
        for name in chain:
            path = self.first_of(self.tree.triggered(name, self.occurrence))
            if path is not None:
                return path
            if self.occurrence.kind == "event" and (
                self.occurrence.subject in self.tree.states[name].defers
            ):
                return DeferredStep(name)
        return None

    def through(self, transition: Transition) -> TransitionPath | None:
        """The compound transition that begins with this one; None when it is disabled."""
        if isinstance(transition.trigger, When) and not self.holds(transition.trigger.condition):
            return None
        if not self.holds(transition.guard):
            return None
        kind = self.tree.kinds.get(transition.target)
        if kind is PseudoKind.JUNCTION:
            rest = self.way_out(transition.target)
            return None if rest is None else (transition, *rest)
        if kind is PseudoKind.JOIN:
            return self.joined(transition.target)
        return (transition,)

    def way_out(self, vertex: str) -> TransitionPath | None:
        """The first enabled path out of a pseudostate."""
        return self.first_of(self.tree.outgoing[vertex])

    def first_of(self, transitions: Sequence[Transition]) -> TransitionPath | None:
        """The first enabled path that begins with one of these."""
        for index, transition in enumerate(transitions):
            path = self.through(transition)
            if path is not None:
                for other in transitions[index + 1 :]:
                    if other.trigger == transition.trigger and not other.otherwise:
                        guard = other.guard
                        can = z3.BoolVal(True) if guard is None else self.value(guard)
                        self.rivals.append(Rival(transition.name, other.name, can))
                return path
        return None

    def joined(self, join: str) -> TransitionPath | None:
        """The segments of a join, when every source has completed."""
        incoming = self.tree.incoming[join]
        if not all(self.has_completed(t.source) for t in incoming):
            return None
        rest = self.way_out(join)
        return None if rest is None else (*incoming, *rest)

    def has_completed(self, state: str) -> bool:
        """Whether a source of a join has completed; yes where its region is unknown."""
        if state in self.before.completed or self.contested is None:
            return state in self.before.completed
        around = self.tree.concurrent_region_of
        return all(around[name] != around[state] for name in self.before.active)

    # --- firing

    def fire_all(self, paths: Sequence[TransitionPath]) -> None:
        """Take the selected transitions; one that conflicts with an earlier one is dropped."""
        self.firing = True
        made: list[TransitionPath] = []
        leaving: dict[str, TransitionPath] = {}
        for index, path in enumerate(paths):
            clash = [o for o in made if self.conflict(path, o) or self.conflict(o, path)]
            if not clash and self.source(path) not in self.active:
                clash = [leaving[self.source(path)]]
            self.beaten += [Beaten(path[0].name, o[0].name, Defeat.CONFLICT) for o in clash]
            if clash:
                continue
            made.append(path)
            before = set(self.active)
            self.fire(path)
            self.settle()
            leaving |= dict.fromkeys(before - self.active, path)
            if self.stopped:
                rest = paths[index + 1 :]
                self.beaten += [Beaten(p[0].name, path[0].name, Defeat.END) for p in rest]
                return

    def conflict(self, one: TransitionPath, other: TransitionPath) -> bool:
        """Whether the first leaves a state that the source of the other is inside."""
        if one[0].kind is TransitionKind.INTERNAL:
            return False
        boundary = self.boundary(one)
        chain = self.tree.chains[self.source(other)]
        return any(self.tree.slots[name] == boundary for name in chain)

    def source(self, path: TransitionPath) -> str:
        """Where a compound transition starts: for a join, the state around its sources."""
        if self.tree.kinds.get(path[0].target) is PseudoKind.JOIN:
            sources = tuple(t.source for t in self.tree.incoming[path[0].target])
            return self.tree.around_all(sources)
        return path[0].source

    def goal(self, path: TransitionPath) -> str:
        """Its target: for a fork, the orthogonal state around the targets."""
        target = path[-1].target
        if self.tree.kinds.get(target) is PseudoKind.FORK:
            targets = tuple(t.target for t in self.tree.outgoing[target])
            return self.tree.around_all(targets)
        return target

    def boundary(self, path: TransitionPath) -> RegionKey:
        """The region whose active child a transition leaves."""
        source, goal = self.source(path), self.goal(path)
        if path[0].kind is TransitionKind.LOCAL and source in self.tree.chains[goal][1:]:
            chain = self.tree.chains[goal]
            return self.tree.slots[chain[chain.index(source) - 1]]
        return self.tree.common(source, goal)

    def fire(self, path: TransitionPath) -> None:
        """Take a compound transition: exits, effects, entries."""
        if path[0].kind is TransitionKind.INTERNAL:
            self.effect(path[0])
            return
        boundary, goal = self.boundary(path), self.goal(path)
        self.leave(boundary)
        for transition in path:
            self.effect(transition)
        target = path[-1].target
        self.enter(self.tree.path(goal, boundary), target if target != goal else None)

    def effect(self, transition: Transition) -> None:
        """Run a transition's effect."""
        self.fired.append(transition.name)
        self.perform(transition.effect)

    def settle(self) -> None:
        """Go on from each pseudostate reached, the first in model order first."""
        while self.arrivals and not self.stopped:
            self.go_on()

    def go_on(self) -> None:
        """Go on from the first pseudostate reached, in model order."""
        vertex = next(self.passing(TOP))
        self.arrivals.remove(vertex)
        kind = self.tree.kinds[vertex]
        if kind is PseudoKind.TERMINATE:
            self.stopped = True
        elif kind in (PseudoKind.HISTORY, PseudoKind.DEEP_HISTORY):
            self.restore(vertex, deep=kind is PseudoKind.DEEP_HISTORY)
        else:
            path = self.way_out(vertex)
            if path is None:
                raise StuckStep(vertex)
            self.fire(path)

    def passing(self, slot: RegionKey) -> Iterator[str]:
        """The pseudostates that have been reached inside a region, in model order."""
        yield from (name for name in self.arrivals if self.tree.slots[name] == slot)
        for name in self.tree.ordered(self.active):
            if self.tree.slots[name] == slot:
                for nested in self.tree.regions_of(name):
                    yield from self.passing(nested)

    # --- exits and entries

    def leave(self, slot: RegionKey) -> None:
        """Leave the active child of a region, inner before outer."""
        self.arrivals = [name for name in self.arrivals if self.tree.slots[name] != slot]
        for name in self.tree.ordered(self.active):
            if self.tree.slots[name] == slot:
                for nested in self.tree.regions_of(name):
                    self.leave(nested)
                self.remember(name)
                self.perform(self.tree.states[name].exit)
                self.active.discard(name)
                self.left.add(name)

    def remember(self, name: str) -> None:
        """Keep the last leaf of each enclosing region, for histories."""
        state = self.tree.states[name]
        if len(state.regions) == 1:
            return
        own = self.tree.slots[name]
        for slot in self.tree.inner_regions(name):
            if slot in self.tree.remembered:
                self.history[slot] = state.parent if state.final and state.parent else name
        if state.final:
            self.history[own] = None

    def enter(self, path: Sequence[str], fork: str | None = None) -> None:
        """Enter the states of a path, then the targets of a fork or the default ones."""
        first, *rest = path
        if first in self.tree.kinds:
            self.arrivals.append(first)
            return
        self.step_into(first)
        segments = {}
        if fork is not None and not rest:
            segments = {self.tree.below(first, t.target): t for t in self.tree.outgoing[fork]}
        for slot in self.tree.regions_of(first):
            if rest and self.tree.slots[rest[0]] == slot:
                self.enter(rest, fork)
            elif slot in segments:
                self.effect(segments[slot])
                self.enter(self.tree.path(segments[slot].target, slot))
            else:
                self.initial(slot)

    def step_into(self, name: str) -> None:
        """Enter one state."""
        self.active.add(name)
        self.entered.add(name)
        self.perform(self.tree.states[name].entry)

    def initial(self, slot: RegionKey) -> None:
        """Enter a region by default."""
        initial = self.tree.region.initial if slot == TOP else self.tree.nested[slot].initial
        self.perform(initial.effect)
        self.enter(self.tree.path(initial.target, slot))

    def restore(self, vertex: str, *, deep: bool) -> None:
        """Enter the states that a history remembers, or its default."""
        slot = self.tree.slots[vertex]
        last = self.last(slot)
        if last is None:
            path = self.way_out(vertex)
            if path is not None:
                self.fire(path)
            else:
                self.initial(slot)
        elif deep:
            self.enter_deep(self.tree.path(last, slot))
        else:
            self.enter(self.tree.path(last, slot)[:1])

    def last(self, slot: RegionKey) -> str | None:
        """The leaf that a region remembers."""
        if slot not in self.history:
            self.history[slot] = self.recall(slot)
        return self.history[slot]

    def enter_deep(self, path: Sequence[str]) -> None:
        """Enter a path, and the regions beside and below it as they were last."""
        first, *rest = path
        self.step_into(first)
        for slot in self.tree.regions_of(first):
            last = self.last(slot) if self.tree.states[first].is_orthogonal else None
            if rest and self.tree.slots[rest[0]] == slot:
                self.enter_deep(rest)
            elif last is not None:
                self.enter_deep(self.tree.path(last, slot))
            else:
                self.initial(slot)

    # --- the end

    def configuration(self) -> Configuration:
        """The configuration after the step, with the completions that the step made."""
        tree = self.tree
        if self.stopped:
            return Configuration(tree.ordered(self.active), stopped=True)
        fresh = self.left | self.entered
        done = {name for name in self.before.done if name not in fresh}
        completed = {name for name in self.before.completed if name not in fresh}
        pending = [name for name in self.before.pending if name not in fresh]
        if self.occurrence.kind == "done":
            done.add(self.occurrence.subject)
        if self.occurrence.kind == "completion" and self.occurrence.subject in pending:
            pending.remove(self.occurrence.subject)
        for name in tree.ordered(self.active):
            if name in tree.completing and name not in completed:
                if name in tree.working and name not in done:
                    continue
                if self.is_finished(name):
                    completed.add(name)
                    pending.append(name)
        return Configuration(
            tree.ordered(self.active),
            tree.ordered(completed),
            tree.ordered(pending),
            tree.ordered(done & tree.completing),
            tuple(sorted(((s, n) for s, n in self.history.items() if n is not None), key=str)),
        )

    def is_finished(self, name: str) -> bool:
        """Whether every region of a state is in a final state of its own."""
        return all(
            any(
                child in self.active and self.tree.states[child].final
                for child in self.active
                if self.tree.slots[child] == (name, nested.name)
            )
            for nested in self.tree.states[name].regions
        )


def raises(action: If) -> bool:
    """Whether one of the branches raises an event."""
    return any(
        isinstance(inner, Raise) or (isinstance(inner, If) and raises(inner))
        for inner in (*action.then, *action.otherwise)
    )
