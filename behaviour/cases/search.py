# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A search for executions that meet the goals: guided by what is still to be shown, and repeatable.

The interpreter is branched at instants where something new was shown or where the system is in a
condition not seen before. From a branch it goes on with events and values from outside, or with
time alone. Where a chart still has something to show from the states that are active, a branch is
preferred, and so is what triggers it. The effort is counted in instants that were executed, not in
time: the same model gives the same cases on every machine.
"""

from __future__ import annotations

import random
from bisect import bisect
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from ravenchart.behaviour.interpreter.branching import branched
from ravenchart.behaviour.interpreter.machine import InstanceRun, Machine
from ravenchart.behaviour.interpreter.region import Stuck
from ravenchart.behaviour.interpreter.stimuli import Arrived, Raised, Stimuli
from ravenchart.behaviour.rules.cells import every
from ravenchart.gen.language.terms import Ns, Raise, Value
from ravenchart.gen.model.component import Component, PortKind
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.statechart import OnEvent
from ravenchart.gen.model.system import Slot, System

from .goals import Goal, GoalCoverage, GoalElement, GoalKind, goals
from .possible import outlook
from .stimulation import Choice, choices
from .watched import watched_machine

EFFORT = 400_000
"""Instants that are executed at the most, unless another number is given."""
WAITS, LONG_WAITS = (1, 1, 2, 2, 4, 8, 20), (4, 20, 60, 200, 600)
"""Instants until the next thing comes from outside; the long ones where little or nothing does."""
QUIET, CALM = 0.15, 0.5
"""How often nothing comes from outside, and how often at the most what keeps ports fresh."""
FED = 0.7
"""How often a port is kept fresh, and how often with the value that it has."""
ANY = 0.5
"""How often a branch is chosen without regard to what is open, from each condition alike."""
COMPARED = 6
"""Branches of which the one is taken that was tried least."""
MORE = 3
"""Once each thing is shown, the leaves that are left are looked for so many times as long."""
ALIKE = 6
"""Branches kept of one condition of the system."""

Stimulus = Raised | Arrived
Instant = tuple[Ns, list[Slot]]


@dataclass(slots=True)
class Branch:
    """The system before its instant ``at``, and what came so far; ``tries`` went on from here."""

    machine: Machine
    at: int
    entries: tuple[Stimulus, ...]
    tries: int = 0


@dataclass(slots=True)
class Feed:
    """A value that comes again and again, ``apart`` in ns."""

    entry: Stimulus
    apart: int
    next: int = 0

    def due(self, now: Ns) -> Iterator[Stimulus]:
        """The value, where it is time."""
        if now >= self.next:
            self.next = now + self.apart
            yield replace(self.entry, at=now)


@dataclass(frozen=True, slots=True)
class FoundCase:
    """Stimuli, and the goals that this case is the first of all to show."""

    stimuli: Stimuli
    shows: tuple[Goal, ...]


@dataclass(slots=True)
class SearchResult:
    """The cases, and the goals that none of them shows, or that none can show."""

    cases: list[FoundCase]
    goals: list[Goal]
    open: list[Goal]
    unreachable: list[Goal]
    executed: int
    stuck: list[Stuck] = field(default_factory=list)
    """One for each pseudostate that was met without a way out; the model is wrong."""


class CaseSearch:
    """One search over a system."""

    def __init__(self, system: System, effort: int = EFFORT) -> None:
        """Nothing is shown yet."""
        self.system, self.effort = system, effort
        self.chance = random.Random(system.name)
        self.coverage = GoalCoverage()
        self.goals = [
            goal
            for component in {i.component.name: i.component for i in system.instances}.values()
            for goal in goals(component)
        ]
        ahead = outlook(system, self.goals)
        self.unreachable = ahead.unreachable
        self.open = [goal for goal in self.goals if goal not in self.unreachable]
        self.choices = choices(system, ahead.values)
        self.instants: list[Instant] = []
        start = watched_machine(system, self.coverage)
        self._coming = start.instants(Ns(2**62))
        self.near: dict[GoalElement, list[Branch]] = {}
        """By component, region and active state."""
        self.known: dict[object, list[Branch]] = {}
        """By the condition of the system."""
        self.alike: list[list[Branch]] = [[Branch(start, 0, ())]]
        self.paths: list[Stimuli] = []
        self.executed = 0
        self.stuck: list[Stuck] = []
        self.causes = {i.name: _causes(i.component) for i in system.instances}
        self.cuts = sorted({number for choice in self.choices for number in choice.numbers})

    def found(self) -> SearchResult:
        """Search, and choose the cases."""
        first = 0
        while self.open and self.executed < self.effort:
            if any(goal.kind is not GoalKind.LEFT for goal in self.open):
                first = self.executed
            elif self.executed > max(MORE * first, self.effort // 10):
                break
            self._go_on(self._best())
        cases = list(self._chosen())
        met = {goal for case in cases for goal in case.shows}
        left = [g for g in self.goals if g not in met and g not in self.unreachable]
        return SearchResult(cases, self.goals, left, self.unreachable, self.executed, self.stuck)

    # --- one try

    def _best(self) -> Branch:
        """One that is near to an open goal, each goal as often as others; sometimes any."""
        near = [
            goal for goal in self._wanted_first() if self.near.get((*goal.element[:2], goal.state))
        ]
        if near and self.chance.random() > ANY:
            goal = self.chance.choice(near)
            pool = self.near[*goal.element[:2], goal.state]
        else:
            alike = [self.chance.choice(self.alike) for _ in range(COMPARED)]
            pool = min(alike, key=lambda some: sum(one.tries for one in some))
        some = [self.chance.choice(pool) for _ in range(COMPARED)]
        return min(some, key=lambda one: one.tries)

    def _wanted_first(self) -> list[Goal]:
        """The open goals; at first not those that ask for more than each thing once."""
        first = [goal for goal in self.open if goal.kind is not GoalKind.LEFT]
        return first if first and 2 * self.executed < self.effort else self.open

    def _keep(self, machine: Machine, at: int, entries: tuple[Stimulus, ...]) -> None:
        """A branch, unless there are enough that are like it."""
        key = tuple(
            (name, *self._condition(run)) for name, run in sorted(machine.instances.items())
        )
        alike = self.known.setdefault(key, [])
        if len(alike) >= ALIKE:
            return
        if not alike:
            self.alike.append(alike)
        branch = Branch(branched(machine), at, entries)
        alike.append(branch)
        for place in self._active(branch):
            self.near.setdefault(place, []).append(branch)

    def _active(self, branch: Branch) -> dict[GoalElement, str]:
        """The active states of each component and region, each with an instance."""
        return {
            (run.component.name, region.region.name, state): name
            for name, run in branch.machine.instances.items()
            for region in run.regions.values()
            for state in region.configuration()
        }

    def _near(self, branch: Branch) -> list[tuple[str, Goal]]:
        """The open goals whose state is active, each with an instance where it is."""
        active = self._active(branch)
        places = ((goal, (*goal.element[:2], goal.state)) for goal in self._wanted_first())
        return [(active[place], goal) for goal, place in places if place in active]

    def _go_on(self, branch: Branch) -> None:
        branch.tries += 1
        machine = branched(branch.machine)
        entries = branch.entries
        at = branch.at
        mood = self.chance.random()
        fed = [] if mood < QUIET else self._fed(machine)
        waits = WAITS if mood > CALM else LONG_WAITS
        for wait in self.chance.choices(waits, k=self.chance.randint(1, 4)):
            now = self._instant(at)[0]
            coming = self._drawn(branch, now) if mood > CALM and self.choices else ()
            for _ in range(wait):
                before = self.coverage.size
                now, slots = self._instant(at)
                coming = (*coming, *(entry for one in fed for entry in one.due(now)))
                entries = (*entries, *coming)
                self.executed += 1
                try:
                    for _ in machine.execute(now, slots, coming):
                        pass
                except Stuck as stuck:
                    if all(one.origin != stuck.origin for one in self.stuck):
                        self.stuck.append(stuck)
                    return
                coming = ()
                at += 1
                if self.coverage.size > before:
                    self.paths.append(Stimuli(entries, now))
                    self.open = [goal for goal in self.open if not self.coverage.shows(goal)]
                    self._keep(machine, at, entries)
            self._keep(machine, at, entries)

    def _fed(self, machine: Machine) -> list[Feed]:
        """Ports that get a value again and again, so that it does not become stale."""
        feeds = []
        for one in self.choices:
            if one.max_age is not None and self.chance.random() < FED:
                entry = one.drawn(Ns(0), self.chance)
                port = machine.instances[one.instance].ports[one.name]
                if port.state != "never_received" and self.chance.random() < FED:
                    entry = Arrived(Ns(0), End(one.instance, one.name), port.value)
                feeds.append(Feed(entry, one.max_age // 2))
        return feeds

    def _drawn(self, branch: Branch, now: Ns) -> tuple[Stimulus, ...]:
        """What comes from outside at an instant: nothing, one thing or two."""
        wanted = self._wanted(branch)
        some = self.chance.choices((0, 1, 2), (2, 6, 1))[0]
        pools = (
            wanted if wanted and self.chance.random() < 0.5 else self.choices for _ in range(some)
        )
        return tuple(self.chance.choice(pool).drawn(now, self.chance) for pool in pools)

    def _wanted(self, branch: Branch) -> list[Choice]:
        """What triggers, from the active states, something that is open."""
        names = set()
        for instance, goal in self._near(branch):
            if goal.kind is GoalKind.DEFERRED:
                names.add((instance, str(goal.detail)))
                continue
            _, region, name = goal.element
            run = branch.machine.instances[instance].regions[region].region
            for transition in run.transitions:
                if transition.name == name and isinstance(transition.trigger, OnEvent):
                    names.add((instance, transition.trigger.event))
        while (
            more := {
                (instance, cause)
                for instance, event in names
                for cause in self.causes[instance].get(event, ())
            }
            - names
        ):
            names |= more
        return [
            one
            for one in self.choices
            if any((one.instance, name) in names for name in (one.name, *one.events))
        ]

    def _instant(self, number: int) -> Instant:
        while len(self.instants) <= number:
            self.instants.append(next(self._coming))
        return self.instants[number]

    # --- what is new

    def _condition(self, run: InstanceRun) -> Iterator[object]:
        for region in run.regions.values():
            yield region.configuration(), len(region.deferred), bool(region.queue)
        for name, value in run.data.items():
            yield name, _cell(value, self.cuts)
        for port in run.component.inputs():
            if port.kind is PortKind.SAMPLED:
                seen = run.ports[port.name]
                yield port.name, seen.state, _cell(seen.value, self.cuts)

    # --- the cases

    def _chosen(self) -> Iterator[FoundCase]:
        """Few paths that show together what all have shown, those that show most first."""
        shown = [(path, self._replayed(path)) for path in self.paths]
        total, left = GoalCoverage(), [g for g in self.goals if self.coverage.shows(g)]
        for path, coverage in sorted(shown, key=lambda one: (-one[1].size, one[0].until)):
            before = total.size
            total.join(coverage)
            if total.size == before:
                continue
            met = tuple(goal for goal in left if total.shows(goal))
            if met:
                left = [goal for goal in left if goal not in met]
                yield FoundCase(path, met)

    def _replayed(self, path: Stimuli) -> GoalCoverage:
        """What one path shows by itself."""
        coverage = GoalCoverage()
        for _ in watched_machine(self.system, coverage).run(path):
            pass
        return coverage


def _causes(component: Component) -> dict[str, set[str]]:
    """The events on which transitions raise an event."""
    found: dict[str, set[str]] = {}
    for region in component.regions:
        for transition in region.transitions:
            if isinstance(transition.trigger, OnEvent):
                for action in every(transition.effect):
                    if isinstance(action, Raise):
                        found.setdefault(action.event, set()).add(transition.trigger.event)
    return found


def _cell(value: Value, cuts: Sequence[int]) -> object:
    """A value, or between which of the numbers that matter it is, and in which quarter."""
    if isinstance(value, tuple):
        return tuple(_cell(one, cuts) for _, one in value)
    if not isinstance(value, int):
        return value
    place = bisect(cuts, value)
    if 0 < place < len(cuts):
        low, high = cuts[place - 1], cuts[place]
        return place, 4 * (value - low) // (high - low)
    return place
