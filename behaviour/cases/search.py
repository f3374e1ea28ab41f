# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A repeatable search for executions that meet the goals, guided by the open goals.

The interpreter is branched at instants where something new was shown or where the system is in a
condition not seen before. From a branch it goes on with events and values from outside, or with
time alone. The search prefers branches whose active states have open goals, and the events that
trigger these goals. The effort counts executed instants, not time: the same model gives the same
cases on every machine.
"""

from __future__ import annotations

import random
from bisect import bisect
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from ravenchart.behaviour.interpreter.branching import branched
from ravenchart.behaviour.interpreter.machine import InstanceRun, Machine
from ravenchart.behaviour.interpreter.region import Stuck
from ravenchart.behaviour.interpreter.stimuli import Arrived, Raised, Stimuli
from ravenchart.behaviour.rules.cells import every
from ravenchart.gen.language.terms import Ns, Raise, Value
from ravenchart.gen.model.component import Component, PortKind
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.statechart import After, Every, OnEvent, Region, Transition
from ravenchart.gen.model.system import Slot, System

from .goals import Goal, GoalCoverage, GoalElement, GoalKind, goals_of, union
from .possible import Outlook, outlook
from .scenes import ScenePlayer
from .stimulation import Choice, choices
from .watched import watched_machine

EFFORT = 400_000
"""Instants executed at most, unless another number is given."""
WAITS, LONG_WAITS = (1, 1, 2, 2, 4, 8, 20), (4, 20, 60, 200, 600)
"""Instants until the next stimulus; the long ones where few or none come."""
QUIET, CALM = 0.15, 0.5
"""How often no stimulus comes, and how often at most values that keep ports fresh."""
FED = 0.7
"""How often a port is kept fresh, and how often with the value that it has."""
ANY = 0.5
"""How often a branch is chosen without regard to open goals, from each condition alike."""
COMPARED = 6
"""Branches that are compared; the one tried least is taken."""
MORE = 3
"""The search for leaves ends at so many times the effort that all other goals took."""
ALIKE = 6
"""Branches kept of one condition of the system."""
GUIDED, PLAYED = 0.5, 0.7
"""Share of the effort for scenes, and how often a scene comes in it."""
WAITED = 0.2
"""Share of the effort in which only time passes, until a time-out of an open goal is due."""
MANY = 64
"""Instants over which their mean distance is taken."""
NOTHING: Mapping[str, str] = {}

Stimulus = Raised | Arrived
Instant = tuple[Ns, list[Slot]]


@dataclass(slots=True)
class Branch:
    """The system before its instant ``at``, and its stimuli so far; ``tries`` went on from here."""

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
        """The value, where it is due."""
        if now >= self.next:
            self.next = now + self.apart
            yield replace(self.entry, at=now)


@dataclass(frozen=True, slots=True)
class FoundCase:
    """Stimuli, and the goals that this case is the first to show."""

    stimuli: Stimuli
    shows: tuple[Goal, ...]
    instance: str | None = None
    """The one that stands alone; None: the case is of the system."""


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

    def __init__(
        self,
        system: System,
        effort: int = EFFORT,
        *,
        needed: Sequence[Goal] | None = None,
        ahead: Outlook | None = None,
        patience: int | None = None,
        given: Mapping[str, str] = NOTHING,
    ) -> None:
        """Nothing is shown yet; ``needed`` are the goals that are looked for, or all.

        ``ahead`` is the outlook on the goals. The search ends once ``patience`` instants
        have shown nothing new, where it is given. A value for a data item comes by the port
        that ``given`` names for the item.
        """
        self.system, self.effort = system, effort
        self.patience = effort if patience is None else patience
        self.chance = random.Random(system.name)
        self.coverage = GoalCoverage()
        self.goals = goals_of(system)
        self.needed = self.goals if needed is None else needed
        self._sought = frozenset(self.needed)
        ahead = outlook(system, self.goals) if ahead is None else ahead
        self.unreachable = ahead.unreachable
        self.open = [goal for goal in self.goals if goal not in self.unreachable]
        values = {(c, given.get(name, name)): some for (c, name), some in ahead.values().items()}
        self.choices = choices(system, values)
        self.ages = {(one.instance, one.name): one.max_age for one in self.choices}
        scenes = {
            instance.name: [
                one.renamed(given) for one in ahead.scenes.get(instance.component.name, ())
            ]
            for instance in system.instances
        }
        self.player = ScenePlayer(scenes, self.choices, self.chance)
        self.instants: list[Instant] = []
        start = watched_machine(system, self.coverage)
        self._coming = start.instants(Ns(2**62))
        self.near: dict[GoalElement, list[Branch]] = {}
        """By component, region and active state."""
        self.known: dict[object, list[Branch]] = {}
        """By the condition of the system."""
        self.alike: list[list[Branch]] = [[Branch(start, 0, ())]]
        self.paths: list[Stimuli] = []
        self.executed = self.waited = self.guided = 0
        self.stuck: list[Stuck] = []
        self.causes = {i.name: _causes(i.component) for i in system.instances}
        self.cuts = sorted({number for choice in self.choices for number in choice.numbers})

    def found(self) -> SearchResult:
        """Search, and choose the cases."""
        first = new = size = 0
        while not self._sought.isdisjoint(self.open) and self.executed < self.effort:
            if self.coverage.size > size:
                size, new = self.coverage.size, self.executed
            if self.executed - new > self.patience:
                break
            if any(goal.kind is not GoalKind.LEFT for goal in self.open):
                first = self.executed
            elif self.executed > max(MORE * first, self.effort // 10):
                break
            self._go_on(self._best())
        cases = list(self._chosen())
        met = {goal for case in cases for goal in case.shows}
        left = [g for g in self.needed if g not in met and g not in self.unreachable]
        return SearchResult(cases, self.goals, left, self.unreachable, self.executed, self.stuck)

    # --- one try

    def _best(self) -> Branch:
        """A branch near an open goal, each goal as often as others; sometimes any branch."""
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
        """The open goals; in the first half of the effort, leaves to be left only if none else."""
        first = [goal for goal in self.open if goal.kind is not GoalKind.LEFT]
        return first if first and 2 * self.executed < self.effort else self.open

    def _keep(self, branch: Branch) -> None:
        """Keep a branch, unless `ALIKE` branches of the same condition are kept."""
        key = tuple(
            (name, *self._condition(run)) for name, run in sorted(branch.machine.instances.items())
        )
        alike = self.known.setdefault(key, [])
        if len(alike) >= ALIKE:
            return
        if not alike:
            self.alike.append(alike)
        kept = Branch(branched(branch.machine), branch.at, branch.entries)
        alike.append(kept)
        for state in self._active(kept):
            self.near.setdefault(state, []).append(kept)

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
        states = ((goal, (*goal.element[:2], goal.state)) for goal in self._wanted_first())
        return [(active[state], goal) for goal, state in states if state in active]

    def _go_on(self, branch: Branch) -> None:
        """Go on from a branch in one of three ways, each with its share of the effort."""
        branch.tries += 1
        branch = Branch(branched(branch.machine), branch.at, branch.entries)
        before = self.executed
        due = self._until_due(branch) if self.waited <= WAITED * self.executed else 0
        if due:
            self._execute(branch, due, (), self._fed(branch.machine, often=1.0))
            self.waited += self.executed - before
        elif self.guided <= GUIDED * self.executed:
            self._play(branch)
            self.guided += self.executed - before
        else:
            self._try(branch)

    def _try(self, branch: Branch) -> None:
        """Go on with any stimuli, or with none for long."""
        mood = self.chance.random()
        fed = [] if mood < QUIET else self._fed(branch.machine)
        waits = WAITS if mood > CALM else LONG_WAITS
        for wait in self.chance.choices(waits, k=self.chance.randint(1, 4)):
            now = self._instant(branch.at)[0]
            coming = self._drawn(branch, now) if mood > CALM and self.choices else ()
            if not self._execute(branch, wait, coming, fed):
                break

    def _play(self, branch: Branch) -> None:
        """Go on with scenes, each with the time that it needs, or with any stimuli."""
        fed = self._fed(branch.machine)
        for wait in self.chance.choices(WAITS, k=self.chance.randint(1, 4)):
            now = self._instant(branch.at)[0]
            scene = None
            if self.chance.random() < PLAYED:
                scene = self.player.played(branch.machine, now, self.coverage)
            if scene is None:
                stages = [self._drawn(branch, now) if self.choices else ()]
            else:
                stages = [some for some in (scene.values, scene.events) if some] or [()]
                fed = [feed for feed in fed if feed.entry.receiver not in scene.receivers]
                fed += self._kept_fresh(scene.values)
                wait = self._instants_in(scene.time)
            for coming in stages:
                now = self._instant(branch.at)[0]
                moved = tuple(replace(one, at=now) for one in coming)
                if not self._execute(branch, wait, moved, fed):
                    return

    def _execute(
        self, branch: Branch, wait: int, coming: tuple[Stimulus, ...], fed: Sequence[Feed]
    ) -> bool:
        """Go on for ``wait`` instants, and keep new branches; False where the machine got stuck."""
        for _ in range(wait):
            before = self.coverage.size
            now, slots = self._instant(branch.at)
            coming = (*coming, *(entry for one in fed for entry in one.due(now)))
            branch.entries = (*branch.entries, *coming)
            self.executed += 1
            try:
                for _ in branch.machine.execute(now, slots, coming):
                    pass
            except Stuck as stuck:
                if all(one.origin != stuck.origin for one in self.stuck):
                    self.stuck.append(stuck)
                return False
            coming = ()
            branch.at += 1
            if self.coverage.size > before:
                self.paths.append(Stimuli(branch.entries, now))
                self.open = [goal for goal in self.open if not self.coverage.shows(goal)]
                self._keep(branch)
        self._keep(branch)
        return True

    def _fed(self, machine: Machine, often: float = FED) -> list[Feed]:
        """Ports that get a value again and again, so that it does not become stale."""
        feeds = []
        for one in self.choices:
            if one.max_age is not None and self.chance.random() < often:
                entry = one.drawn(Ns(0), self.chance)
                port = machine.instances[one.instance].ports[one.name]
                if port.state != "never_received" and self.chance.random() < often:
                    entry = Arrived(Ns(0), End(one.instance, one.name), port.value)
                feeds.append(Feed(entry, one.max_age // 2))
        return feeds

    def _until_due(self, branch: Branch) -> int:
        """Instants until the longest time-out of an open goal of the active states is due."""
        longest = 0
        for instance, goal in self._near(branch):
            region, one = _of_goal(branch, instance, goal)
            if one is not None and isinstance(one.trigger, After | Every):
                longest = max(longest, one.trigger.executions * region.timing.period)
        return self._instants_in(longest) + 2 * WAITS[-1] if longest else 0

    def _instants_in(self, time: int) -> int:
        """The number of instants in a time, and one more."""
        return time * MANY // max(1, self._instant(MANY)[0]) + 1

    def _kept_fresh(self, coming: Sequence[Stimulus]) -> Iterator[Feed]:
        """The given values, repeated where they grow stale."""
        for entry in coming:
            age = self.ages.get(entry.receiver)
            if age is not None:
                yield Feed(entry, age // 2, entry.at + age // 2)

    def _drawn(self, branch: Branch, now: Ns) -> tuple[Stimulus, ...]:
        """The stimuli from outside at an instant: none, one or two."""
        wanted = self._wanted(branch)
        some = self.chance.choices((0, 1, 2), (2, 6, 1))[0]
        pools = (
            wanted if wanted and self.chance.random() < 0.5 else self.choices for _ in range(some)
        )
        return tuple(self.chance.choice(pool).drawn(now, self.chance) for pool in pools)

    def _wanted(self, branch: Branch) -> list[Choice]:
        """The stimuli that trigger an open goal of the active states, or raise its event."""
        names = set()
        for instance, goal in self._near(branch):
            if goal.kind is GoalKind.DEFERRED:
                names.add((instance, str(goal.detail)))
                continue
            _, transition = _of_goal(branch, instance, goal)
            if transition is not None and isinstance(transition.trigger, OnEvent):
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
        """Few paths that together show the coverage of all, those that show most first."""
        paths = [(path, self._replayed(path)) for path in self.paths]
        paths.sort(key=lambda one: (-one[1].size, one[0].until))
        total, left = GoalCoverage(), [g for g in self.needed if self.coverage.shows(g)]
        for path, coverage in paths:
            more = union(total, coverage)
            met = tuple(goal for goal in left if more.shows(goal))
            if met:
                total, left = more, [goal for goal in left if goal not in met]
                yield FoundCase(path, met)
        for goal in left:
            #  a condition decides by itself where two evaluations are compared
            for path, coverage in _together(goal, total, paths):
                total = union(total, coverage)
                yield FoundCase(path, (goal,) if total.shows(goal) else ())

    def _replayed(self, path: Stimuli) -> GoalCoverage:
        """The coverage of one path by itself."""
        coverage = GoalCoverage()
        for _ in watched_machine(self.system, coverage).run(path):
            pass
        return coverage


def _of_goal(branch: Branch, instance: str, goal: Goal) -> tuple[Region, Transition | None]:
    """The region of a goal, and its transition; None where the goal is a state's."""
    _, name, element = goal.element
    run = branch.machine.instances[instance].regions[name]
    return run.region, run.tree.transitions.get(element)


def _together(
    goal: Goal, total: GoalCoverage, paths: Sequence[tuple[Stimuli, GoalCoverage]]
) -> list[tuple[Stimuli, GoalCoverage]]:
    """The paths that show a goal only together, added to the coverage ``total``."""
    found: list[tuple[Stimuli, GoalCoverage]] = []
    for one in paths:
        if union(total, *(coverage for _, coverage in found)).shows(goal):
            break
        found.append(one)
    for one in list(found):
        others = [other for other in found if other is not one]
        if union(total, *(coverage for _, coverage in others)).shows(goal):
            found = others
    return found


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
    """A value, or the numbers in ``cuts`` that it lies between, and in which quarter."""
    if isinstance(value, tuple):
        return tuple(_cell(one, cuts) for _, one in value)
    if not isinstance(value, int):
        return value
    above = bisect(cuts, value)
    if 0 < above < len(cuts):
        low, high = cuts[above - 1], cuts[above]
        return above, 4 * (value - low) // (high - low)
    return above
