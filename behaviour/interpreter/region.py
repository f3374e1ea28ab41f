# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One top-level region, interpreted: its configuration, and the steps that change it.

The configuration has the active vertex of every region. A choice, history or terminate
pseudostate is active only within a step: a transition into one is completed
like any other, and then the next one leaves from there.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from ravenchart.behaviour.tree import TOP, ChartTree, RegionKey
from ravenchart.gen.language.terms import Flow, Value
from ravenchart.gen.model.statechart import (
    After,
    Completion,
    Every,
    OnEvent,
    Overflow,
    PseudoKind,
    Region,
    Transition,
    TransitionKind,
    When,
)
from ravenchart.gen.origins import Origin

from .expressions import Outbox, View, holds, perform

MOST_SEGMENTS = 1_000
"""Pseudostates passed at most after one transition; more of them form a cycle."""


class Stuck(Exception):  # noqa: N818
    """A pseudostate has no way out now; the model is wrong."""

    def __init__(self, origin: Origin, message: str) -> None:
        """Stuck at the pseudostate at ``origin``."""
        super().__init__(message)
        self.origin = origin


# --- Occurrences -------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Completed:
    """A state has completed."""

    state: str


@dataclass(frozen=True, slots=True)
class TimeOut:
    """The time-out of a transition is due."""

    transition: Transition


@dataclass(frozen=True, slots=True)
class Happened:
    """An event of the component, with its value."""

    event: str
    value: Value | None = None


@dataclass(frozen=True, slots=True)
class Nothing:
    """Nothing waits: conditions are evaluated."""


Occurrence = Completed | TimeOut | Happened | Nothing


# --- What a step does ----------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class NamedGoal:
    """A vertex to enter, and the segment of a fork that leads to it."""

    vertex: str
    segment: Transition | None = None


@dataclass(frozen=True, slots=True)
class ExecutedTransition:
    """A compound transition that was selected: its guards have been read."""

    source: str
    scope: RegionKey
    """Everything in this region is left."""
    effects: tuple[Transition, ...]
    goals: tuple[NamedGoal, ...]
    internal: bool = False


@dataclass(frozen=True, slots=True)
class Deferral:
    """A state defers the event."""


@dataclass(slots=True)
class Kept:
    """A deferred event; free once a state that defers it has been left."""

    happened: Happened
    is_free: bool = False


@dataclass(slots=True)
class Step:
    """The behaviours that one step executed, in order, and its values and events to deliver."""

    behaviours: list[str] = field(default_factory=list)
    out: Outbox = field(default_factory=Outbox)
    lost: int = 0
    """Events that found no room among the deferred."""


class RegionRun:
    """A region that runs. ``works_in`` names its states that have a do activity."""

    def __init__(
        self, region: Region, overflow: Mapping[str, Overflow], works_in: Iterable[str] = ()
    ) -> None:
        """Before its first execution; ``overflow`` is the policy of events that have their own."""
        self.region = region
        self.tree = ChartTree(region)
        self.overflow = overflow
        self.works_in = frozenset(works_in)
        self.active: dict[RegionKey, str] = {}
        self.history: dict[RegionKey, str] = {}
        """The leaf that was left last in a region."""
        self.timers: dict[str, int] = {}
        """Transitions with a running time-out: the execution in which it is due."""
        self.completed: set[str] = set()
        """States whose completion waits for its step."""
        self.done: set[str] = set()
        """Active states whose do activity is done."""
        self.deferred: list[Kept] = []
        self.queue: deque[Happened] = deque()
        self.executions = 0
        self.stopped = False
        self.published = frozenset(self.tree.default)
        self._view: View
        self._step: Step
        self._left: set[str] = set()
        """States left in this step."""

    # --- from outside

    def offer(self, event: str, value: Value | None = None) -> bool:
        """Queue an event; False when one was lost over it."""
        fits = len(self.queue) < self.region.queue_depth
        if not fits and self.overflow.get(event, self.region.overflow) is Overflow.DROP_OLDEST:
            self.queue.popleft()
            self.queue.append(Happened(event, value))
        elif fits:
            self.queue.append(Happened(event, value))
        return fits

    def finish(self, state: str) -> None:
        """The do activity of ``state`` is done."""
        if self.is_active(state) and state not in self.done:
            self.done.add(state)
            self._complete(state)

    def begin(self) -> None:
        """Another execution begins: time goes on."""
        self.executions += 1

    def step(self, view: View) -> Step:
        """One run-to-completion step."""
        self._view, self._step, self._left = view, Step(), set()
        if self.stopped:
            return self._step
        if not self.active:
            self._enter_region(TOP, ())
            self._settle()
            return self._step
        occurrence = self._next()
        view.event = occurrence.value if isinstance(occurrence, Happened) else None
        if self.tree.asks_own:
            view.active = {**view.active, self.region.name: self.configuration()}
        selected = list(self._selected(TOP, occurrence))
        if any(isinstance(one, Deferral) for one in selected):
            assert isinstance(occurrence, Happened)
            self._defer(occurrence)
        else:
            self._fire_all([one for one in selected if isinstance(one, ExecutedTransition)])
        return self._step

    def publish(self) -> None:
        """Let others see the active states."""
        self.published = self.configuration()

    def configuration(self) -> frozenset[str]:
        """The active states."""
        return frozenset(one for one in self.active.values() if one in self.tree.states)

    def is_active(self, vertex: str) -> bool:
        """Whether a vertex is active."""
        return self.active.get(self.tree.slots[vertex]) == vertex

    # --- the next occurrence

    def _next(self) -> Occurrence:
        """The next occurrence, removed from where it waited."""
        for state in self.tree.states:
            if state in self.completed:
                self.completed.remove(state)
                return Completed(state)
        due = [
            (self.timers[t.name], index, t)
            for index, t in enumerate(self.region.transitions)
            if self.timers.get(t.name, self.executions + 1) <= self.executions
        ]
        if due:
            _, _, expired = min(due, key=lambda one: one[:2])
            if isinstance(expired.trigger, Every):
                self.timers[expired.name] += expired.trigger.executions
            else:
                del self.timers[expired.name]
            return TimeOut(expired)
        kept = {event for state in self.configuration() for event in self._defers(state)}
        for index, waiting in enumerate(self.deferred):
            if waiting.is_free or waiting.happened.event not in kept:
                return self.deferred.pop(index).happened
        return self.queue.popleft() if self.queue else Nothing()

    def _defers(self, state: str) -> tuple[str, ...]:
        return self.tree.states[state].defers

    def _defer(self, event: Happened) -> None:
        if len(self.deferred) < self.region.deferral_depth:
            self.deferred.append(Kept(event))
        else:
            self._step.lost += 1

    # --- selection

    def _selected(
        self, region: RegionKey, occurrence: Occurrence
    ) -> Iterator[ExecutedTransition | Deferral]:
        """The selection in a region: from inside the active state, or else of the state itself."""
        state = self.active.get(region)
        if state not in self.tree.states:
            return
        inside = [
            one
            for nested in self.tree.regions_of(state)
            for one in self._selected(nested, occurrence)
        ]
        if inside:
            yield from inside
            return
        for transition in self.tree.outgoing[state]:
            if self._triggers(transition, occurrence):
                firing = self._enabled(transition)
                if firing is not None:
                    yield firing
                    return
        if isinstance(occurrence, Happened) and occurrence.event in self._defers(state):
            yield Deferral()

    def _triggers(self, transition: Transition, occurrence: Occurrence) -> bool:
        match occurrence, transition.trigger:
            case Completed(state), Completion():
                return state == transition.source
            case TimeOut(expired), After() | Every():
                return expired == transition
            case Happened(event), OnEvent(named):
                return event == named
            case Nothing(), When(condition):
                return holds(condition, self._view)
        return False

    def _enabled(self, first: Transition) -> ExecutedTransition | None:
        """The compound transition that begins with ``first``, when all its guards hold."""
        if not self._lets_through(first):
            return None
        if first.kind is TransitionKind.INTERNAL:
            region = self.tree.slots[first.source]
            return ExecutedTransition(first.source, region, (first,), (), internal=True)
        path = self._path((first,))
        if path is None:
            return None
        target = path[-1].target
        goals: tuple[NamedGoal, ...] = (NamedGoal(target),)
        if self.tree.kinds.get(target) is PseudoKind.FORK:
            goals = tuple(NamedGoal(s.target, s) for s in self.tree.outgoing[target])
        ends = [goal.vertex for goal in goals]
        sources = [t.source for t in path if t.source in self.tree.states] or [first.source]
        scope = self.tree.common(*sources, *ends)
        if first.kind is TransitionKind.LOCAL:
            within = [p for p in self.tree.regions_of(first.source) if self._is_in(p, *ends)]
            scope = within[0] if within else scope
        return ExecutedTransition(first.source, scope, path, goals)

    def _is_in(self, region: RegionKey, *vertices: str) -> bool:
        return all(region in self.tree.regions_around(vertex) for vertex in vertices)

    def _path(self, taken: tuple[Transition, ...]) -> tuple[Transition, ...] | None:
        """The first way on through junctions and joins whose guards all hold."""
        vertex = taken[-1].target
        kind = self.tree.kinds.get(vertex)
        if kind is PseudoKind.JOIN:
            taken = tuple(self.tree.incoming[vertex])
            if not all(self._ready(segment) for segment in taken):
                return None
        elif kind is not PseudoKind.JUNCTION:
            return taken
        for segment in self.tree.outgoing[vertex]:
            if segment not in taken and self._lets_through(segment):
                path = self._path((*taken, segment))
                if path is not None:
                    return path
        return None

    def _ready(self, segment: Transition) -> bool:
        """Whether a segment may enter its join."""
        source = segment.source
        active = self.is_active(source) and self._is_complete(source)
        return active and self._lets_through(segment)

    def _lets_through(self, transition: Transition) -> bool:
        """Whether its guard holds now."""
        return holds(transition.guard, self._view)

    # --- firing

    def _fire_all(self, selected: Sequence[ExecutedTransition]) -> None:
        """Take transitions in order, without those that conflict with one already taken."""
        fired: list[ExecutedTransition] = []
        for firing in selected:
            leaves = {s for s in self.tree.around(firing.source) if self._is_in(firing.scope, s)}
            conflicts = firing.source in self._left or any(
                leaves.intersection(self.tree.around(earlier.source)) for earlier in fired
            )
            if not conflicts and not self.stopped:
                self._fire(firing)
                self._settle()
                fired.append(firing)

    def _fire(self, firing: ExecutedTransition) -> None:
        if not firing.internal:
            self._exit_region(firing.scope)
        for transition in firing.effects:
            self._effect(transition)
        if not firing.internal:
            self._enter_region(firing.scope, firing.goals)

    def _settle(self) -> None:
        """Go on from choices and histories, in model order, until none is active."""
        for _ in range(MOST_SEGMENTS):
            reached = next(self._passing(TOP), None)
            if reached is None or self.stopped:
                return
            match self.tree.kinds.get(reached):
                case PseudoKind.TERMINATE:
                    self.stopped = True
                case PseudoKind.CHOICE:
                    self._fire(self._way_out(reached))
                case _:
                    self._restore(reached)
        message = f"{self.region.name} goes from pseudostate to pseudostate without end"
        raise Stuck(self.region.origin, message)

    def _passing(self, region: RegionKey) -> Iterator[str]:
        """The pseudostates that are active, in model order."""
        vertex = self.active.get(region)
        if vertex in self.tree.kinds:
            yield vertex
        elif vertex is not None:
            for nested in self.tree.regions_of(vertex):
                yield from self._passing(nested)

    def _way_out(self, vertex: str) -> ExecutedTransition:
        """The first enabled segment from a pseudostate."""
        for segment in self.tree.outgoing[vertex]:
            firing = self._enabled(segment)
            if firing is not None:
                return firing
        origin = self.tree.pseudostates[vertex].origin
        raise Stuck(origin, f"{vertex} has no way out: no guard holds")

    def _restore(self, vertex: str) -> None:
        """Go on from a history pseudostate."""
        region = self.tree.slots[vertex]
        last = self.history.get(region)
        if last is None and self.tree.outgoing[vertex]:
            self._fire(self._way_out(vertex))
            return
        goals: list[str] = []
        if self.tree.kinds.get(vertex) is PseudoKind.DEEP_HISTORY:
            goals = self._recorded(region)
        elif last is not None:
            goals = [self.tree.path(last, region)[0]]
        del self.active[region]
        self._enter_region(region, tuple(NamedGoal(goal) for goal in goals))

    def _recorded(self, region: RegionKey) -> list[str]:
        """The leaves that deep history finds in a region; none: enter it by default."""
        last = self.history.get(region)
        if last is None:
            return []
        state = self.tree.states[last]
        if state.final:
            return [self.tree.around(last)[0]]
        below = [goal for nested in self.tree.regions_of(last) for goal in self._recorded(nested)]
        return below or [last]

    # --- leaving and entering

    def _exit_region(self, region: RegionKey) -> None:
        vertex = self.active.get(region)
        if vertex in self.tree.states:
            self._exit(vertex)
        self.active.pop(region, None)

    def _exit(self, name: str) -> None:
        for nested in self.tree.regions_of(name):
            self._exit_region(nested)
        state = self.tree.states[name]
        if not state.final:
            self._behave(f"{name}.exit", state.exit)
        for transition in self.tree.outgoing[name]:
            self.timers.pop(transition.name, None)
        for kept in self.deferred:
            kept.is_free = kept.is_free or kept.happened.event in state.defers
        self._left.add(name)
        self.completed.discard(name)
        self.done.discard(name)
        if self.tree.is_innermost(name):
            for region in self.tree.inner_regions(name):
                self.history[region] = name
            if state.final:
                del self.history[self.tree.slots[name]]

    def _enter_region(self, region: RegionKey, goals: Sequence[NamedGoal]) -> None:
        """Enter a region on the way to goals in it, or by default when there is none."""
        if not goals:
            goals = (self._initial(region),)
        elif len(goals) == 1 and goals[0].segment is not None:
            self._effect(goals[0].segment)
            goals = (NamedGoal(goals[0].vertex),)
        vertex = self.tree.path(goals[0].vertex, region)[0]
        self.active[region] = vertex
        if vertex in self.tree.states:
            self._enter(vertex, [goal for goal in goals if goal.vertex != vertex])

    def _initial(self, region: RegionKey) -> NamedGoal:
        """Take the initial transition of a region."""
        owner, name = region
        if owner is None:
            initial, shown = self.region.initial, self.region.name
        else:
            initial, shown = self.tree.states[owner].nested(name).initial, name or owner
        if initial.effect:
            self._behave(f"initial({shown}).effect", initial.effect)
        return NamedGoal(initial.target)

    def _enter(self, name: str, goals: Sequence[NamedGoal]) -> None:
        state = self.tree.states[name]
        if not state.final:
            self._behave(f"{name}.entry", state.entry)
        for transition in self.tree.outgoing[name]:
            if isinstance(transition.trigger, After | Every):
                self.timers[transition.name] = self.executions + transition.trigger.executions
        for nested in self.tree.regions_of(name):
            inside = [goal for goal in goals if self._is_in(nested, goal.vertex)]
            self._enter_region(nested, inside)
        if state.final and state.parent is not None:
            self._complete(state.parent)
        elif state.is_leaf:
            self._complete(name)

    # --- completion

    def _complete(self, state: str) -> None:
        """Let the completion of a state wait for its step, if it is complete."""
        if state in self.tree.completing and self._is_complete(state):
            self.completed.add(state)

    def _is_complete(self, state: str) -> bool:
        """Whether an active state is: its regions final, its do activity done."""
        inside = [self.active.get(region) for region in self.tree.regions_of(state)]
        final = all(one in self.tree.states and self.tree.states[one].final for one in inside)
        return final and (state not in self.works_in or state in self.done)

    # --- behaviours

    def _effect(self, transition: Transition) -> None:
        self._behave(f"{transition.name}.effect", transition.effect)

    def _behave(self, label: str, flow: Flow) -> None:
        self._step.behaviours.append(label)
        perform(flow, self._view, self._step.out)
